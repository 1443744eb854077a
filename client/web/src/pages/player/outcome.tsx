/** The result of the own match: over the field, or on a phone in the place of the keys. */

import type { Court } from "../../core/court";
import type { Player } from "../../core/player";
import { t } from "../../i18n";
import { ResultCard } from "../../ui/result";
import { official } from "./steps";

interface Props {
  court: Court;
  player: Player;
  /** Whether the line over the field says what comes next. */
  isLast: boolean;
  onSave: () => void;
}

export function Outcome({ court, player, isLast, onSave }: Props) {
  return (
    <ResultCard
      match={court}
      own={player.index.value}
      withReplay
      isLast={isLast}
      next={official(player)}
    >
      {player.data && player.data.length > 0 && (
        <button class="button" type="button" onClick={onSave}>
          {t("end.save")}
        </button>
      )}
    </ResultCard>
  );
}
