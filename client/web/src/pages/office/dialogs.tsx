/** What the organiser does with one team: its link, its late files, taking it out. */

import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { toBase64 } from "../../core/base64";
import type { Effect, TeamPicture } from "../../core/desk";
import { pictureUrl } from "../../core/picture";
import { said, t } from "../../i18n";
import { copy } from "../../ui/copy";
import { Dialog } from "../../ui/dialog";
import { stateOf } from "./entries";
import type { Organiser } from "./organiser";

interface Props {
  organiser: Organiser;
  team: string;
}

/** Copies a link, so that it can be sent. */
export function CopyButton({ link }: { link: string }) {
  return (
    <button class="button" type="button" onClick={() => void copy(link)}>
      {t("office.copy")}
    </button>
  );
}

/** A team: its link with the QR code, and what can be done. */
export function TeamDialog({ organiser, team }: Props) {
  const row = organiser.view.value?.teams.find((one) => one.team === team);
  useEffect(() => void organiser.getLinks(team), [organiser, team]);
  const link = organiser.links.value?.teams.find((one) => one.team === team);
  if (!row) return null;
  const isIn = row.state === "in" || row.state === "late";
  return (
    <Dialog title={team} onClose={() => organiser.close()}>
      <div class="asks">
        <p class="muted">{stateOf(row)}</p>
        {row.files && (
          <p>
            {t("office.hash")} <code>{row.files}</code>
          </p>
        )}
        {link && (
          <div class="qr">
            <img src={pictureUrl(link.qr)} alt={t("office.qrOf", { team })} />
            <div>
              <p>{t("office.link")}</p>
              <a href={link.link}>{link.link}</a>
              <CopyButton link={link.link} />
            </div>
          </div>
        )}
        {row.picture && <PictureOf organiser={organiser} team={team} />}
        {row.contact && <p>{t("office.contact", { contact: row.contact })}</p>}
        {row.club && <p>{t("office.club", { club: row.club })}</p>}
        {row.substitute && (
          <button
            class="button"
            type="button"
            onClick={() => {
              organiser.over.value = { is: "substitute", team };
            }}
          >
            {t("office.substitute")}
          </button>
        )}
        {isIn && (
          <button
            class="button danger"
            type="button"
            onClick={() => {
              organiser.over.value = { is: "leave", team };
            }}
          >
            {t("office.takeOut")}
          </button>
        )}
      </div>
    </Dialog>
  );
}

/** The picture that a team gave of itself; the organiser can take it away. */
function PictureOf({ organiser, team }: Props) {
  const picture = useSignal("");
  useEffect(() => {
    void organiser.act<TeamPicture>({ do: "picture", team }).then((found) => {
      if (found?.webp.length) picture.value = `data:image/webp;base64,${toBase64(found.webp)}`;
    });
  }, [organiser, team, picture]);
  return (
    <div class="picture-of">
      {picture.value && <img src={picture.value} alt={t("office.picture", { team })} />}
      <button
        class="button"
        type="button"
        onClick={() => void organiser.do({ do: "picture", team, remove: true })}
      >
        {t("office.removePicture")}
      </button>
    </div>
  );
}

/** A team or files that came after the end of entries: the organiser allows it, and says why. */
export function ApproveDialog({ organiser, team }: Props) {
  const reason = useSignal("");
  const row = organiser.view.value?.teams.find((one) => one.team === team);
  return (
    <Dialog title={t("office.late.title", { team })} onClose={() => organiser.close()}>
      <form
        class="asks"
        onSubmit={async (event) => {
          event.preventDefault();
          const done = await organiser.do({
            do: "approve",
            teams: [team],
            reason: reason.value.trim(),
          });
          if (done) organiser.close();
        }}
      >
        <p>{t(row?.state === "waits" ? "office.late.team" : "office.late.text")}</p>
        <Reason reason={reason} />
        <button class="button strong" type="submit" disabled={!reason.value.trim()}>
          {t("office.approve")}
        </button>
      </form>
    </Dialog>
  );
}

/** The organiser turns applications or late files down; the dialog says what becomes of them. */
export function DeclineDialog({ organiser, teams }: { organiser: Organiser; teams: string[] }) {
  const [team = ""] = teams;
  const many = teams.length > 1;
  const row = organiser.view.value?.teams.find((one) => one.team === team);
  if (!row) return null;
  const count = teams.length;
  const one = row.state === "late" ? "office.decline.late" : "office.decline.text";
  const text = many ? "office.decline.many" : one;
  return (
    <Dialog
      title={many ? t("office.declineAll", { count }) : t("office.declineOf", { team })}
      onClose={() => organiser.close()}
    >
      <div class="asks">
        <p>{t(text)}</p>
        {many && <p class="muted">{teams.join(t("office.comma"))}</p>}
        <button
          class="button danger"
          type="button"
          onClick={async () => {
            if (await organiser.do({ do: "decline", teams })) organiser.close();
          }}
        >
          {t("office.decline")}
        </button>
      </div>
    </Dialog>
  );
}

/** The organiser makes another event code, because strangers have the old one. */
export function CodeDialog({ organiser }: { organiser: Organiser }) {
  return (
    <Dialog title={t("office.newCode")} onClose={() => organiser.close()}>
      <div class="asks">
        <p>{t("office.newCode.text")}</p>
        <button
          class="button danger"
          type="button"
          onClick={async () => {
            if (await organiser.do({ do: "new_code" })) organiser.close();
          }}
        >
          {t("office.newCode")}
        </button>
      </div>
    </Dialog>
  );
}

/** The organiser takes a team out; the dialog shows what that changes. */
export function LeaveDialog({ organiser, team }: Props) {
  const reason = useSignal("");
  const expelled = useSignal(false);
  const effect = useSignal<Effect | null>(null);
  const disqualify = expelled.value;
  useEffect(() => {
    let newest = true;
    void organiser.preview({ do: "take_out", team, disqualify }).then((found) => {
      if (newest) effect.value = found;
    });
    return () => {
      newest = false;
    };
  }, [organiser, team, disqualify]);
  return (
    <Dialog title={t("office.leave.title", { team })} onClose={() => organiser.close()}>
      <form
        class="asks"
        onSubmit={async (event) => {
          event.preventDefault();
          const wish = {
            do: "take_out",
            team,
            disqualify,
            reason: reason.value.trim(),
            really: true,
          } as const;
          if (await organiser.act(wish)) organiser.close();
        }}
      >
        <label class="check">
          <input
            type="checkbox"
            checked={disqualify}
            onChange={(event) => {
              expelled.value = event.currentTarget.checked;
            }}
          />
          {t("office.leave.disqualify")}
        </label>
        <Reason reason={reason} />
        <Effects effect={effect.value} />
        <button class="button danger" type="submit" disabled={!reason.value.trim()}>
          {t("office.takeOut")}
        </button>
      </form>
    </Dialog>
  );
}

/** The field for a reason, which everybody can read. */
export function Reason({
  reason,
  optional = false,
}: {
  reason: { value: string };
  optional?: boolean;
}) {
  return (
    <label class="field">
      <span>{t(optional ? "office.reason.optional" : "office.reason")}</span>
      <input
        value={reason.value}
        maxLength={200}
        required={!optional}
        onInput={(event) => {
          reason.value = event.currentTarget.value;
        }}
      />
    </label>
  );
}

/** What a decision would change, before it is made. */
export function Effects({ effect }: { effect: Effect | null }) {
  return (
    <section class="effects" aria-live="polite">
      {effect && (
        <>
          <h3>{t("office.effect")}</h3>
          <ul>
            {effect.lines.map((line, index) => (
              <li key={index}>{said(line)}</li>
            ))}
          </ul>
        </>
      )}
    </section>
  );
}
