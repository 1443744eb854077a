/** Changes of the robot's numbers, one after another. */

import { Refused } from "../../../core/connection";
import { numberOf } from "../../../core/design/table";
import type { Phrase } from "../../../core/phrase";
import type { RobotReply } from "../../../core/wire";
import { type MessageName, said, t } from "../../../i18n";
import { toast } from "../../../ui/toasts";
import type { Files } from "../files/files";
import type { ReadRobot, RobotInUse } from "./robot";
import { limitText, pairOf, textOf, unitOf } from "./units";

const DECIMALS = 1e6;
/** How a robot is refused whose lowest part is not on the floor or just above it. */
const BAD_START = "robot.start-height";

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
  set(name: string, text: string, gesture: string): Promise<string | null> {
    const done = this.robot.settled.then(() => this.change(name, text, gesture));
    this.robot.settled = done.catch(() => null);
    return done;
  }

  private async change(name: string, text: string, gesture: string): Promise<string | null> {
    const used = this.robot.used.peek();
    if (!used) return null;
    const unit = unitOf(name);
    const [low, high] = pairOf(used.reply, name);
    const value = `${textOf(low, unit)}${low < high ? ` – ${textOf(high, unit)}` : ""} ${unit.shown}`;
    const typed = numberOf(text);
    if (typed === null) return t("design.noRobotNumber", { value });
    const wanted = round(typed / unit.times);
    if (low === high && round(low) === wanted) return null;
    const limits = used.reply.limits[name] as [number | null, number | null] | undefined;
    if (wanted < (limits?.[0] ?? -Infinity) || wanted > (limits?.[1] ?? Infinity)) {
      return t("design.outside", { limits: `${limitText(limits, unit)} ${unit.shown}`, value });
    }
    try {
      const changed = await this.changed(used, name, wanted);
      const label = t(`design.fact.${name}` as MessageName);
      this.files.takeRobot(t("design.step.number", { number: label }), changed, gesture);
      return null;
    } catch (error) {
      if (!(error instanceof Refused)) throw error;
      return t("design.robotRefused", { why: reasons(error), value });
    }
  }

  /** The robot with the number. Where its feet would start in the floor, it starts higher. */
  private async changed(used: ReadRobot, name: string, value: number): Promise<ReadRobot> {
    if (name === "drop_m") {
      const height = startOf(used.reply) + value - pairOf(used.reply, "drop_m")[0];
      return await this.robot.changed(used, { start_height_m: round(height) });
    }
    try {
      return await this.robot.changed(used, { [name]: value });
    } catch (error) {
      const least = error instanceof Refused ? leastStart(error) : null;
      if (least === null) throw error;
      const drop = pairOf(used.reply, "drop_m")[0];
      const start_height_m = round(least + drop);
      const raised = await this.robot.changed(used, { [name]: value, start_height_m });
      toast(t("design.startFollows"));
      return raised;
    }
  }
}

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

function startOf(robot: RobotReply): number {
  return pairOf(robot, "start_height_m")[0];
}

function round(number: number): number {
  return Math.round(number * DECIMALS) / DECIMALS;
}
