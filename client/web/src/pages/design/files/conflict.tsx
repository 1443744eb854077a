/** What is asked and said of files: they have changed meanwhile, or have mistakes. */

import { t } from "../../../i18n";
import { Dialog } from "../../../ui/dialog";
import { Mistakes } from "../../../ui/mistakes";
import type { Gateway } from "../gateway";
import { LegPicture } from "../robot/legs";
import type { RobotInUse } from "../robot/robot";
import type { Sheet } from "../table/sheet";
import type { Files } from "./files";

/** The file has another content than the page thought: nothing is lost without being asked for. */
export function ConflictDialog({ files }: { files: Files }) {
  const conflict = files.conflict.value;
  if (!conflict) return null;
  const { name, when, table, robot, mistakes, of } = conflict;
  const isThere = table !== null || robot !== null;
  const isRobot = of === "robot";
  const saving = when !== "open";
  // A browser says only with its next picture that a dialog has closed: there may be another by then.
  const close = () => {
    if (files.conflict.peek() === conflict) files.conflict.value = null;
  };
  return (
    <Dialog
      key={conflict}
      title={t(when === "existing" ? "design.exists" : "design.conflict")}
      onClose={close}
    >
      <p>
        {t(isRobot && when === "open" ? "design.conflict.robot" : `design.conflict.${when}`, {
          name,
        })}
      </p>
      {mistakes.length > 0 && <Mistakes mistakes={mistakes} />}
      {!isThere && !mistakes.length && <p>{t("design.conflictGone", { name })}</p>}
      <div class="row end">
        <button
          class="button"
          type="button"
          disabled={!isThere}
          onClick={() => void files.takeTheirs()}
        >
          {t(isRobot ? "design.takeTheirRobot" : "design.takeTheirs")}
        </button>
        <button
          class="button strong"
          type="button"
          onClick={() => {
            if (!saving) files.keepMine();
            else if (isRobot) void files.keepRobot(true);
            else void files.save(name, true);
          }}
        >
          {t(`design.${saving ? "overwrite" : "keepMine"}${isRobot ? "Robot" : ""}`)}
        </button>
      </div>
    </Dialog>
  );
}

interface TroubleProps {
  gateway: Gateway;
  robot: RobotInUse;
  sheet: Sheet;
}

/** Every mistake of a file or a table, with its place. */
export function TroubleDialog({ gateway, robot, sheet }: TroubleProps) {
  const trouble = gateway.trouble.value;
  if (!trouble) return null;
  return (
    <Dialog
      title={t("design.trouble")}
      onClose={() => {
        gateway.trouble.value = null;
        sheet.point([]);
      }}
    >
      <Mistakes
        mistakes={trouble.mistakes}
        onPoint={(mistake) => sheet.point(mistake?.joint == null ? [] : [mistake.joint])}
      />
      {trouble.mistakes.some(({ joint }) => joint != null) && (
        <LegPicture robot={robot.robot.value} sheet={sheet} />
      )}
    </Dialog>
  );
}
