/** Changes of the robot's numbers, one after another. */

import { Refused } from "../../../core/connection";
import { numberOf } from "../../../core/design/table";
import { mirrorLeg } from "../../../core/design/tools";
import { cos, sin } from "../../../core/leg/leg";
import type { Phrase } from "../../../core/phrase";
import type { RobotReply } from "../../../core/wire";
import { type MessageName, said, t } from "../../../i18n";
import { toast } from "../../../ui/toasts";
import type { Files } from "../files/files";
import type { Change, ReadRobot, RobotInUse } from "./robot";
import { limitText, pairOf, type RobotNumber, textOf, unitOf } from "./units";

const DECIMALS = 1e6;
/** How a robot is refused whose lowest part is not on the floor or just above it. */
const BAD_START = "robot.start-height";
const whole = (entry: string): RobotNumber => ({ entry, leg: null });

export class Numbers {
  constructor(
    private readonly robot: RobotInUse,
    private readonly files: Files,
  ) {}

  /**
   * Give the robot another number, after the changes before it.
   *
   * @param text As it was typed, in the unit that is shown.
   * @param gesture Changes in a row with the same gesture are one step.
   * @returns Why the robot stays as it is; null: it has the number.
   */
  set(number: RobotNumber, text: string, gesture: string): Promise<string | null> {
    const done = this.robot.settled.then(() => this.change(number, text, gesture));
    this.robot.settled = done.catch(() => null);
    return done;
  }

  private async change(number: RobotNumber, text: string, gesture: string): Promise<string | null> {
    const used = this.robot.used.peek();
    if (!used) return null;
    const { entry } = number;
    const unit = unitOf(entry);
    const [low, high] = pairOf(used.reply, number);
    const value = `${textOf(low, unit)}${low < high ? ` – ${textOf(high, unit)}` : ""} ${unit.shown}`;
    const typed = numberOf(text);
    if (typed === null) return t("design.noRobotNumber", { value });
    const wanted = round(typed / unit.times);
    if (low === high && round(low) === wanted) return null;
    const limits = used.reply.limits[entry] as [number | null, number | null] | undefined;
    if (wanted < (limits?.[0] ?? -Infinity) || wanted > (limits?.[1] ?? Infinity)) {
      return t("design.outside", { limits: `${limitText(limits, unit)} ${unit.shown}`, value });
    }
    try {
      const changed = await this.changed(used, number, wanted);
      const label = t(`design.fact.${entry}` as MessageName);
      this.files.takeRobot(t("design.step.number", { number: label }), changed, gesture);
      return null;
    } catch (error) {
      if (!(error instanceof Refused)) throw error;
      return t("design.robotRefused", { why: reasons(error), value });
    }
  }

  /** The robot with the number. Where its feet would start in the floor, it starts higher. */
  private async changed(used: ReadRobot, number: RobotNumber, value: number): Promise<ReadRobot> {
    const start = whole("start_height_m");
    const drop = pairOf(used.reply, whole("drop_m"))[0];
    if (number.entry === "drop_m") {
      const height = pairOf(used.reply, start)[0] + value - drop;
      return await this.robot.changed(used, [[start, round(height)]]);
    }
    const changes = withMirror(used.reply, number, value);
    try {
      return await this.robot.changed(used, changes);
    } catch (error) {
      const least = error instanceof Refused ? leastStart(error) : null;
      if (least === null) throw error;
      const raised = await this.robot.changed(used, [...changes, [start, round(least + drop)]]);
      toast(t("design.startFollows"));
      return raised;
    }
  }
}

/** A change, and that of the leg on the other side, if that is the mirror of this one now. */
function withMirror(robot: RobotReply, number: RobotNumber, value: number): Change[] {
  const { entry, leg } = number;
  const changes: Change[] = [[number, value]];
  if (leg === null) return changes;
  const mirror = mirrorLeg(leg, robot.legs.length);
  const [one, other] = [robot.shapes[leg]!, robot.shapes[mirror]!];
  const [x, y, z] = one.position_mm;
  const isMirror =
    same(other.position_mm[0], -x) &&
    same(other.position_mm[1], y) &&
    same(other.position_mm[2], z) &&
    same(cos(other.outward_deg), -cos(one.outward_deg)) &&
    same(sin(other.outward_deg), sin(one.outward_deg));
  if (!isMirror) return changes;
  // Written as the file has it: 225 degrees stay above 180.
  const turned = other.outward_deg - (value - one.outward_deg);
  const mirrored = { leg_x_m: -value, leg_outward_deg: turned }[entry] ?? value;
  return [...changes, [{ entry, leg: mirror }, round(mirrored)]];
}

const same = (one: number, other: number) => Math.abs(one - other) < 1e-6;

/** The least height of the start, if that is all that is wrong with a robot. */
function leastStart({ mistakes }: Refused): number | null {
  const expected = mistakes.length === 1 ? (mistakes[0]!.expected as Phrase) : null;
  const least = expected?.code === BAD_START ? expected.values?.low_m : null;
  return typeof least === "number" ? least : null;
}

function reasons({ why, mistakes }: Refused): string {
  if (!mistakes.length) return said(why);
  const each = mistakes.map(({ field, found, expected }) => {
    const what = t("mistake.expected", { expected: said(expected) });
    return `${field ? `${field}: ` : ""}${said(found)} ${what}`;
  });
  return [...new Set(each)].join(" ");
}

function round(number: number): number {
  return Math.round(number * DECIMALS) / DECIMALS;
}
