/** Offers a gait that would take the place of the own one. */

import { t } from "../../../i18n";
import { Banner } from "../../../ui/banner";

interface Props {
  /** What is offered, as a sentence. */
  text: string;
  onTake: () => void;
  onLater: () => void;
}

export function Offer({ text, onTake, onLater }: Props) {
  return (
    <Banner calm>
      <span>{text}</span>
      <span class="offer">
        <button class="button strong" type="button" onClick={onTake}>
          {t("design.handed.take")}
        </button>
        <button class="button" type="button" onClick={onLater}>
          {t("design.handed.later")}
        </button>
      </span>
    </Banner>
  );
}
