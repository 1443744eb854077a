/** The dialog that tests the link to the court: figures, and one sentence that says what they mean. */

import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import type { Court } from "../../core/court";
import { type LinkFound, LinkTest } from "../../core/link_test";
import { t } from "../../i18n";
import { Dialog } from "../../ui/dialog";

interface Props {
  court: Court;
  onClose: () => void;
}

export function LinkTestDialog({ court, onClose }: Props) {
  const test = useSignal<LinkTest | null>(null);
  const begin = () => {
    test.peek()?.end();
    test.value = new LinkTest(court);
  };
  useEffect(() => {
    begin();
    return () => test.peek()?.end();
  }, [court]);
  const found = test.value?.found.value ?? null;
  return (
    <Dialog title={t("linktest.title")} onClose={onClose}>
      <div class="link-test">
        <p class="muted">{t("linktest.text")}</p>
        {found ? <Found link={found} /> : <progress value={test.value?.done.value ?? 0} />}
        <p role="status" class={`verdict-line ${found?.verdict ?? ""}`}>
          {t(found ? `linktest.${found.verdict}` : "linktest.runs")}
        </p>
        <button class="button" type="button" disabled={!found} onClick={begin}>
          {t("linktest.again")}
        </button>
      </div>
    </Dialog>
  );
}

function Found({ link }: { link: LinkFound }) {
  const ms = (value: number | null) =>
    value === null ? t("linktest.noAnswer") : t("foot.ms", { count: Math.round(value) });
  const { frames, lost, late } = link;
  return (
    <dl class="facts">
      <dt>{t("linktest.p50")}</dt>
      <dd>{ms(link.p50Ms)}</dd>
      <dt>{t("linktest.p95")}</dt>
      <dd>{ms(link.p95Ms)}</dd>
      <dt>{t("linktest.frames")}</dt>
      <dd>{frames ? t("linktest.missed", { frames, lost, late }) : t("linktest.noFrames")}</dd>
    </dl>
  );
}
