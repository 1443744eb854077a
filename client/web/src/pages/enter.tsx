/** A team enters with event code, name and files; then the page shows its state and its link. */

import { useSignal } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";
import { t } from "../i18n";
import { Banner, NoticeBanner, waitsForGateway } from "../ui/banner";
import { Dropping, useDrop } from "../ui/drop";
import { IconButton } from "../ui/icons";
import { Settings } from "../ui/settings";
import { Toasts } from "../ui/toasts";
import { Entrant } from "./enter/entrant";
import { take } from "./enter/files";
import { EntryCard, Form } from "./enter/form";
import "./enter/enter.css";

export default function Enter() {
  const entrant = useMemo(() => new Entrant(), []);
  const dragging = useSignal(false);
  const settings = useSignal(false);
  useDrop(dragging, (files) => void take(files));
  useEffect(() => {
    document.title = `${t("enter.title")} – LACOC`;
  });
  const waits = waitsForGateway(entrant.desk.connection.state.value);
  return (
    <>
      {waits ? <Banner>{waits}</Banner> : <NoticeBanner notice={entrant.notice.value} />}
      <main class="enter">
        <div class="card">
          {entrant.entry.value && <EntryCard entrant={entrant} entry={entrant.entry.value} />}
          {!entrant.entry.value && <Form entrant={entrant} />}
        </div>
        <IconButton
          name="settings"
          label={t("settings.title")}
          onClick={() => {
            settings.value = true;
          }}
        />
      </main>
      {settings.value && (
        <Settings
          onClose={() => {
            settings.value = false;
          }}
        />
      )}
      <Dropping dragging={dragging}>{t("enter.drop")}</Dropping>
      <Toasts />
    </>
  );
}
