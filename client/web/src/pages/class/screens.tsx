/** What fills the screen, for the whole room: how to join, and the standings. */

import { short } from "../../core/address";
import { pictureUrl } from "../../core/picture";
import { t } from "../../i18n";
import { IconButton } from "../../ui/icons";
import { toggleFullscreen } from "../../ui/screen";
import { Frame } from "./frame";
import { addressOf } from "./head";
import type { Teacher } from "./teacher";
import { Standings } from "./tournament";
import { Walk } from "./walk";

/** The screen that is open, if there is one. */
export function Screens({ teacher }: { teacher: Teacher }) {
  const screen = teacher.screen.value;
  if (!screen) return null;
  const close = () => {
    teacher.screen.value = null;
  };
  if (screen.shows === "robot") return <Walk teacher={teacher} name={screen.name} />;
  if (screen.shows === "standings") {
    return (
      <Frame label={t("class.play.standings")} onClose={close}>
        <div class="big-standings">
          <h2>{t("class.play.standings")}</h2>
          <Standings teacher={teacher} big />
        </div>
      </Frame>
    );
  }
  return (
    <Frame label={t("class.join")} onClose={close}>
      <Room teacher={teacher} />
    </Frame>
  );
}

/** How to join, in three steps. */
function Room({ teacher }: { teacher: Teacher }) {
  const qr = teacher.state.value?.qr;
  return (
    <div class="room">
      <h2>{t("class.join")}</h2>
      {qr && <img class="qr" src={pictureUrl(qr)} alt={t("class.qr")} />}
      <ol>
        <li>
          <span>{t("class.join.1")}</span>
          <b>{short(addressOf(teacher))}</b>
        </li>
        <li>
          <span>{t("class.join.2")}</span>
          <b class="code">{teacher.state.value?.code}</b>
        </li>
        <li>
          <span>{t("class.join.3")}</span>
        </li>
      </ol>
      <p>
        {t("class.here", { count: teacher.here.value, all: teacher.cards.value.length })}
        <IconButton name="full" label={t("class.screen.full")} onClick={toggleFullscreen} />
      </p>
    </div>
  );
}
