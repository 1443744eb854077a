/** Shares a gait: a link, a picture and a film of the shown trial. */

import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { download } from "../../../core/files";
import { t } from "../../../i18n";
import { copy } from "../../../ui/copy";
import { Dialog } from "../../../ui/dialog";
import type { Studio } from "../studio";
import { canFilm } from "./shots";
import "./share.css";

interface Props {
  studio: Studio;
  onClose: () => void;
}

export function ShareDialog({ studio, onClose }: Props) {
  const { friend, gateway, showing, shots } = studio;
  const link = useSignal<string | null>(null);
  const isFilming = useSignal(false);
  useEffect(() => {
    friend.link().then(
      (made) => {
        link.value = made ?? "";
      },
      (error) => gateway.refuse(error),
    );
  }, [friend, gateway]);
  const tried = showing.shown.value;
  const name = tried ? `trial-${tried.number}` : "gait";
  const isOwn = ["localhost", "127.0.0.1", "[::1]"].includes(location.hostname);
  return (
    <Dialog title={t("design.share")} onClose={onClose}>
      <div class="design-share">
        <h3>{t("design.share.link")}</h3>
        {link.value === "" ? (
          <p class="warning">{t("design.badCells", { count: studio.sheet.bad.value.length })}</p>
        ) : (
          <div class="row">
            <input
              readOnly
              aria-label={t("design.share.link")}
              value={link.value ?? "…"}
              onFocus={(event) => event.currentTarget.select()}
            />
            <button
              class="button strong"
              type="button"
              disabled={!link.value}
              onClick={() => void copy(link.value!)}
            >
              {t("design.share.copy")}
            </button>
          </div>
        )}
        <p class="muted">{t("design.share.linkHint")}</p>
        <p class="muted">{t(isOwn ? "design.share.own" : "design.share.paste")}</p>
        <h3>{t("design.share.shots")}</h3>
        <div class="row">
          <button
            class="button"
            type="button"
            onClick={async () => {
              const made = await shots.picture();
              if (made) download(`${name}.png`, [made], made.type);
            }}
          >
            {t("design.share.picture")}
          </button>
          {tried && canFilm() && (
            <button
              class="button"
              type="button"
              aria-busy={isFilming.value}
              disabled={isFilming.value}
              onClick={async () => {
                isFilming.value = true;
                const made = await shots.film(showing, tried);
                isFilming.value = false;
                download(`${name}.${made.type.split("/")[1]}`, [made], made.type);
              }}
            >
              {t(isFilming.value ? "design.share.filming" : "design.share.film")}
            </button>
          )}
        </div>
        {!tried && <p class="muted">{t("design.share.tryFirst")}</p>}
      </div>
    </Dialog>
  );
}
