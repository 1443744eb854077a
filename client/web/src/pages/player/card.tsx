/** The card before a seat is held: who, where, with what. */

import { useComputed, useSignal } from "@preact/signals";
import { goToCourt } from "../../core/address";
import { isAboutToken } from "../../core/claim";
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
const seatKept = remembered("seat", "");

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
      if (team?.hasOffice.value) return <TeamCard court={court} team={team} />;
      return court.welcome.value ? <JoinCard court={court} player={player} alone={alone} /> : null;
    default:
      return null;
  }
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

function JoinCard({ court, player, alone }: Props) {
  const welcome = court.welcome.value!;
  const { prefill, courts } = welcome;
  const { lastWish, refusal, request } = player.claim.value;
  const sheet = court.sheet.value;
  const seats = sheet?.seats.map((seat) => seat.id) ?? [];
  const name = useSignal(prefill?.name || lastWish?.name || nameKept.peek());
  const token = useSignal(lastWish?.token ?? "");
  const isShown = useSignal(false);
  const complaint = useSignal<"" | "name" | "token">("");
  const chosen = useSignal(prefill?.seat ?? "");
  const free = useFreeSeats(court);
  // Who was in a seat before comes back to it; anybody else is offered one that is free.
  const kept = seats.indexOf(seatKept.peek());
  const isOwn = kept >= 0 && sheet?.seats[kept]?.team === nameKept.peek();
  const offered = isOwn || free.includes(kept) ? seats[kept] : seats[free[0] ?? 0];
  const seat = seats.includes(chosen.value) ? chosen.value : (offered ?? "");
  const hasToken = Boolean(prefill?.has_token);
  const aboutToken = refusal !== null && isAboutToken(refusal);
  const isBusy = request !== "none" || player.isWaiting.value;

  const submit = (event: Event) => {
    event.preventDefault();
    const clean = name.value.trim();
    const length = [...clean].length;
    const missing = !token.value.trim() && !hasToken;
    complaint.value = !length || length > NAME_MAX ? "name" : missing ? "token" : "";
    if (complaint.value) {
      document.getElementById(`join-${complaint.value}`)?.focus();
      return;
    }
    nameKept.value = clean;
    seatKept.value = seat;
    player.join({
      court: welcome.court ?? "",
      seat,
      token: token.value.trim() || null,
      name: clean,
    });
  };

  return (
    <form class="card entrance join" aria-labelledby="entrance-title" onSubmit={submit}>
      <h1 id="entrance-title">{t(alone ? "join.practice" : "join.title")}</h1>
      {welcome.contest && <p class="muted">{welcome.contest}</p>}
      {courts.length > 1 && (
        <label class="field">
          <span>{t("join.court")}</span>
          <select
            value={welcome.court ?? ""}
            onChange={(event) => goToCourt(event.currentTarget.value)}
          >
            {courts.map((one) => (
              <option key={one}>{one}</option>
            ))}
          </select>
        </label>
      )}
      {sheet && (
        <fieldset class="seats">
          <legend>
            {t("join.seat")} · {played(sheet)}
          </legend>
          {sheet.seats.map((one, index) => (
            <label key={one.id} class={`seat${one.id === seat ? " on" : ""}`} data-seat={index}>
              <input
                type="radio"
                name="seat"
                value={one.id}
                checked={one.id === seat}
                onChange={() => {
                  chosen.value = one.id;
                }}
              />
              <span class="seat-mark" data-pattern={one.pattern} aria-hidden="true">
                {one.id.slice(0, 1).toUpperCase()}
              </span>
              <span>
                {seatName(one.id)}
                <SeatTaken court={court} sheet={sheet} index={index} />
              </span>
            </label>
          ))}
        </fieldset>
      )}
      <div class="pair">
        <label class="field">
          <span>{t("join.name")}</span>
          <input
            id="join-name"
            value={name.value}
            placeholder={t("join.nameHint", { most: NAME_MAX })}
            autocomplete="organization"
            aria-invalid={complaint.value === "name"}
            aria-describedby="join-name-error"
            onInput={(event) => {
              name.value = event.currentTarget.value;
            }}
          />
          <p class="error" id="join-name-error" role="alert">
            {complaint.value === "name" && t("join.nameMissing", { most: NAME_MAX })}
          </p>
        </label>
        <div class="field">
          <label for="join-token">{t("join.token")}</label>
          <div class="with-button">
            <input
              id="join-token"
              type={(isShown.value ? "text" : "password") as "password"}
              value={token.value}
              placeholder={t(hasToken ? "join.tokenGiven" : "join.tokenHint")}
              autocomplete="off"
              spellcheck={false}
              aria-invalid={aboutToken || complaint.value === "token"}
              aria-describedby="join-token-error"
              onInput={(event) => {
                token.value = event.currentTarget.value;
              }}
            />
            <button
              class="button quiet"
              type="button"
              onClick={() => {
                isShown.value = !isShown.value;
              }}
            >
              {t(isShown.value ? "join.hide" : "join.show")}
            </button>
          </div>
          <p class="error" id="join-token-error" role="alert">
            {complaint.value === "token" && t("join.tokenMissing")}
            {!complaint.value && aboutToken && said(refusal.why)}
          </p>
        </div>
      </div>
      <FilePicker court={court} alone={alone} />
      {refusal && !aboutToken && (
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
    </form>
  );
}

/** Indices of the seats that nobody holds. */
function useFreeSeats(court: Court): number[] {
  const flags = useComputed(
    () => court.frame.value?.seats.map((seat) => seat.flags & SeatFlag.JOINED).join() ?? "",
  ).value;
  return flags.split(",").flatMap((joined, index) => (Number(joined) ? [] : [index]));
}

function SeatTaken({ court, sheet, index }: { court: Court; sheet: Sheet; index: number }) {
  const isTaken = useComputed(
    () => ((court.frame.value?.seats[index]?.flags ?? 0) & SeatFlag.JOINED) > 0,
  ).value;
  return (
    <small>{isTaken ? t("join.takenBy", { team: team(sheet, index) }) : t("join.free")}</small>
  );
}
