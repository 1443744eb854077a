/** The card before a seat is held: who, where, with what. */

import { useComputed, useSignal } from "@preact/signals";
import { setting } from "../../core/address";
import type { Court } from "../../core/court";
import type { Player } from "../../core/player";
import { remembered } from "../../core/settings";
import type { Team } from "../../core/team";
import { NAME_MAX, SeatFlag, type Sheet } from "../../core/wire";
import { said, sentence, t } from "../../i18n";
import { played, seatName, team } from "../../i18n/words";
import { Mistakes } from "../../ui/mistakes";
import { FilePicker } from "./files";
import { TeamCard } from "./team";

const nameKept = remembered("team", "");

interface Props {
  court: Court;
  player: Player;
  alone: boolean;
}

interface EntranceProps extends Props {
  /** null: practice has none. */
  team: Team | null;
}

/** What stands in the place of the field's controls while no seat is held. */
export function Entrance({ court, player, alone, team }: EntranceProps) {
  switch (player.standing.value) {
    case "watching":
      return <WatchOnly alone={alone} />;
    case "lost":
      return <Gone court={court} player={player} alone={alone} isLost />;
    case "left":
      return <Gone court={court} player={player} alone={alone} />;
    case "outside":
      if (!court.welcome.value || team?.going.value) return <OnTheWay team={team} />;
      if (team && !(team.isOn.value && team.there.value?.open))
        return <TeamCard court={court} team={team} />;
      return <JoinCard court={court} player={player} alone={alone} team={team} />;
    default:
      return null;
  }
}

/** The page goes to a court, or has come to it and waits for its first word. */
function OnTheWay({ team }: { team: Team | null }) {
  const going = team?.going.value;
  const court = going || setting("court");
  if (!court) return null;
  return (
    <section class="card entrance" role="status">
      <h1>{t(going ? "team.going" : "team.connecting", { court })}</h1>
      <span class="spinner" aria-hidden="true" />
    </section>
  );
}

function WatchOnly({ alone }: { alone: boolean }) {
  return (
    <section class="card entrance" aria-labelledby="entrance-title">
      <h1 id="entrance-title">{t("watching.title")}</h1>
      <p>{t(alone ? "watching.practice" : "watching.text")}</p>
      <a class="button strong" href={`watch${location.search}`}>
        {t("watching.watch")}
      </a>
    </section>
  );
}

/** The seat was lost or given up: one button brings it back. */
function Gone({ player, alone, isLost }: Props & { isLost?: boolean }) {
  const { lastWish: wish, why } = player.claim.value;
  const text = alone ? t("left.practice") : t("left.text");
  return (
    <section class="card entrance" aria-labelledby="entrance-title">
      <h1 id="entrance-title">{t(isLost ? "lost.title" : "left.title")}</h1>
      <p role={isLost ? "alert" : undefined}>{why ? sentence(why) : text}</p>
      <div class="row">
        {wish && (
          <button class="button strong large" type="button" onClick={() => player.join(wish)}>
            {t(alone ? "left.practiceAgain" : "join.again")}
          </button>
        )}
        {!alone && (
          <button class="button" type="button" onClick={() => player.forget()}>
            {t("join.title")}
          </button>
        )}
      </div>
    </section>
  );
}

function JoinCard({ court, player, alone, team }: EntranceProps) {
  const welcome = court.welcome.value!;
  const { prefill } = welcome;
  const { lastWish, refusal, request } = player.claim.value;
  const sheet = court.sheet.value;
  const name = useSignal(prefill?.name || lastWish?.name || nameKept.peek());
  const isNameless = useSignal(false);
  const seat = team?.there.value?.seat || prefill?.seat || sheet?.seats[0]?.id || "";
  const index = sheet?.seats.findIndex(({ id }) => id === seat) ?? -1;
  const isBusy = request !== "none" || player.isWaiting.value;

  const submit = (event: Event) => {
    event.preventDefault();
    const clean = name.value.trim();
    const { length } = [...clean];
    isNameless.value = !length || length > NAME_MAX;
    if (isNameless.value) {
      document.getElementById("join-name")?.focus();
      return;
    }
    nameKept.value = clean;
    if (team) team.sit(clean);
    else player.join({ court: welcome.court ?? "", seat, token: null, name: clean });
  };

  return (
    <form class="card entrance join" aria-labelledby="entrance-title" onSubmit={submit}>
      <h1 id="entrance-title">{t(alone ? "join.practice" : "join.title")}</h1>
      {welcome.contest && <p class="muted">{welcome.contest}</p>}
      {sheet && index >= 0 && (
        <p class="own-seat" data-seat={index}>
          <span class="seat-mark" data-pattern={sheet.seats[index]!.pattern} aria-hidden="true">
            {seat.slice(0, 1).toUpperCase()}
          </span>
          <span>
            {seatName(seat)} · {played(sheet)}
            <SeatTaken court={court} sheet={sheet} index={index} />
          </span>
        </p>
      )}
      <label class="field">
        <span>{t("join.name")}</span>
        <input
          id="join-name"
          value={name.value}
          placeholder={t("join.nameHint", { most: NAME_MAX })}
          autocomplete="organization"
          aria-invalid={isNameless.value}
          aria-describedby="join-name-error"
          onInput={(event) => {
            name.value = event.currentTarget.value;
          }}
        />
        <p class="error" id="join-name-error" role="alert">
          {isNameless.value && t("join.nameMissing", { most: NAME_MAX })}
        </p>
      </label>
      <FilePicker court={court} alone={alone} />
      {refusal && (
        <div class="refusal" role="alert">
          <strong>{t("join.refused")}</strong>
          <p>{said(refusal.why)}</p>
          {refusal.mistakes.length > 0 && <Mistakes mistakes={refusal.mistakes} />}
        </div>
      )}
      <button class="button strong large" type="submit" disabled={isBusy}>
        {isBusy && <span class="spinner" aria-hidden="true" />}
        {t(isBusy ? "join.going" : "join.go")}
      </button>
      {isBusy && !court.link.value?.connected && <p class="muted">{t("join.waits")}</p>}
      {welcome.home === "venue" && <p class="muted safety">{t("join.safety")}</p>}
      {team && (
        <button class="button quiet small" type="button" onClick={() => team.forget()}>
          {t("team.other")}
        </button>
      )}
    </form>
  );
}

function SeatTaken({ court, sheet, index }: { court: Court; sheet: Sheet; index: number }) {
  const isTaken = useComputed(
    () => ((court.frame.value?.seats[index]?.flags ?? 0) & SeatFlag.JOINED) > 0,
  ).value;
  return (
    <small>{isTaken ? t("join.takenBy", { team: team(sheet, index) }) : t("join.free")}</small>
  );
}
