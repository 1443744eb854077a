/** Six variants of the gait: one or two are kept, and the next six are bred from them. */

import { t } from "../../../i18n";
import { classes } from "../names";
import { Acts, speedOf, wordsOf } from "./other";
import { MOST_KEPT, type Others, type Round } from "./others";

interface Props {
  others: Others;
  round: Round;
  /** The word of phase 5; "": none. */
  word: string;
  /** Figures of the own gait; null: it was not tried. */
  before: Record<string, unknown> | null;
}

export function Variants({ others, round, word, before }: Props) {
  const number = others.at.value + 1;
  return (
    <div class="variants">
      {word && <h3>{t("design.variants.word", { word })}</h3>}
      <p class="muted">{t("design.variants.keepHint", { round: number })}</p>
      {!round.variants.length && <p>{t("design.variants.none")}</p>}
      <ul>
        {round.variants.map((gait, index) => {
          const isKept = round.kept.includes(index);
          const name = t("design.variants.name", { number: `${number}.${index + 1}` });
          return (
            <li key={index} class={classes(isKept && "kept")} aria-label={name}>
              <b>
                {index + 1} · {speedOf(gait)}
              </b>
              <span>{wordsOf(gait, before).join(t("design.way.and"))}</span>
              <label class="keep">
                <input type="checkbox" checked={isKept} onChange={() => others.keep(index)} />
                {t("design.variants.keep")}
              </label>
              <Acts others={others} gait={gait} name={name} />
            </li>
          );
        })}
      </ul>
      <div class="row">
        <button
          class="button"
          type="button"
          disabled={others.at.value === 0}
          onClick={() => others.back()}
        >
          {t("design.variants.back")}
        </button>
        <button
          class={classes("button", round.kept.length > 0 && "strong")}
          type="button"
          disabled={!round.kept.length || others.isSearching}
          title={t("design.variants.keepHint", { round: number, most: MOST_KEPT })}
          onClick={() => void others.next()}
        >
          {t("design.variants.next")}
        </button>
      </div>
    </div>
  );
}
