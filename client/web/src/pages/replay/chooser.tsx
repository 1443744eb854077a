/** Where recordings come from: the server's folder, or this machine. */

import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { ownPage } from "../../core/address";
import { type BadRecord, type Listed, listed, type Summary } from "../../core/record_files";
import { type MessageName, t } from "../../i18n";
import { dateTime, seatName } from "../../i18n/words";
import { Icon } from "../../ui/icons";

interface Props {
  /** What went wrong with the last choice. */
  trouble: BadRecord | null;
  onServer: (name: string) => void;
  onFiles: (files: readonly File[]) => void;
}

export function Chooser({ trouble, onServer, onFiles }: Props) {
  const found = useSignal<readonly Listed[] | null>(null);
  const noServer = useSignal(false);
  useEffect(() => {
    if (ownPage) return;
    listed().then(
      (list) => {
        found.value = list;
      },
      () => {
        noServer.value = true;
      },
    );
  }, [found, noServer]);
  return (
    <div class="chooser">
      <header>
        <h1>{t("replay.title")}</h1>
        {ownPage ? <a href="./">{t("home.contest")}</a> : <a href="watch">{t("home.watch")}</a>}
      </header>
      {trouble && (
        <p class="trouble" role="alert">
          {troubleText(trouble)}
        </p>
      )}
      <label class="drop-here">
        <input
          type="file"
          multiple
          accept=".mcap"
          onChange={(event) => {
            onFiles([...(event.currentTarget.files ?? [])]);
            event.currentTarget.value = "";
          }}
        />
        <Icon name="open" />
        <b>{t("replay.choose")}</b>
        <span class="muted">{t("replay.dropHint")}</span>
      </label>
      <section aria-label={t("replay.onServer")} hidden={ownPage !== null}>
        <h2>{t("replay.onServer")}</h2>
        {noServer.value && <p class="muted">{t("replay.noList")}</p>}
        {found.value?.length === 0 && <p class="muted">{t("replay.noneYet")}</p>}
        <ul class="recordings">
          {found.value?.map((file) => (
            <li key={file.name}>
              <a
                href={`?file=${encodeURIComponent(file.name)}`}
                onClick={(event) => {
                  if (event.ctrlKey || event.metaKey || event.shiftKey) return;
                  event.preventDefault();
                  onServer(file.name);
                }}
              >
                {file.match ? (
                  <MatchLine match={file.match} />
                ) : (
                  <b>{file.name.replace(/\.mcap$/, "")}</b>
                )}
                <span class="muted">
                  {file.match && `${file.match.title} · `}
                  {dateTime(file.match?.started ?? file.modified)}
                  {" · "}
                  {file.match
                    ? t("replay.where", { court: file.match.court, number: file.match.number })
                    : size(file.bytes)}
                </span>
              </a>
            </li>
          ))}
        </ul>
      </section>
    </div>
  );
}

/** Who played, and how it ended. */
function MatchLine({ match }: { match: Summary }) {
  const { teams, seats, scores, winner } = match;
  const team = (index: number) => (
    <span class={seats[index] === winner ? "won" : ""}>
      {teams[index] || seatName(seats[index] ?? "")}
    </span>
  );
  if (teams.length !== 2) return <b>{teams.map((_, index) => team(index))}</b>;
  return (
    <b>
      {team(0)} <span class="points">{scores.length ? scores.join(" : ") : "–"}</span> {team(1)}
      {match.fork_of && <small class="fork"> {t("replay.forkShort")}</small>}
      {winner === "void" && <small> {t("phase.8")}</small>}
    </b>
  );
}

/** What went wrong, in a sentence. */
export function troubleText(trouble: BadRecord): string {
  return t(`replay.bad.${trouble.why}` as MessageName, trouble.holes);
}

function size(bytes: number): string {
  return bytes < 1e6
    ? `${Math.max(1, Math.round(bytes / 1e3))} kB`
    : `${(bytes / 1e6).toFixed(1)} MB`;
}
