/** What the organiser prints; the browser can also print it into a PDF. */

import type { ComponentChildren } from "preact";
import { useEffect } from "preact/hooks";
import { places } from "../../core/contest/places";
import type { ContestSheet } from "../../core/contest/sheet";
import type { OfficeView } from "../../core/desk";
import { pictureUrl } from "../../core/picture";
import { wholeDay } from "../../core/timetable";
import { said, t } from "../../i18n";
import { seatName, timeOf } from "../../i18n/words";
import { Certificate, Papers } from "../../ui/papers";
import { Schedule } from "../contest/schedule";
import { Tables } from "../contest/standings";
import { gameTitle, placeTitle, stageTitle } from "../contest/words";
import type { Organiser, Paper } from "./organiser";

interface Props {
  organiser: Organiser;
  paper: Paper;
}

export function OfficePapers({ organiser, paper }: Props) {
  const view = organiser.view.value;
  const sheet = organiser.feed.sheet.value;
  useEffect(() => {
    if (paper === "links") void organiser.getLinks();
  }, [organiser, paper]);
  return (
    <Papers paper={paper} hint={t("office.paper.hint")} onBack={() => organiser.close()}>
      {view && sheet && paper === "schedule" && <Times view={view} sheet={sheet} />}
      {view && paper === "links" && <Links organiser={organiser} view={view} />}
      {sheet && paper === "results" && <Results sheet={sheet} />}
      {sheet && paper === "certificates" && <Certificates sheet={sheet} />}
    </Papers>
  );
}

/** When and where each game was played, with its result, and each match will be. */
function Times({ view, sheet }: { view: OfficeView; sheet: ContestSheet }) {
  return (
    <section class="sheet-of-paper">
      <h1>{view.event.name}</h1>
      {view.slots.length > 0 && <p>{t("office.paper.estimate")}</p>}
      {wholeDay(view, sheet).map(({ court, played, slots }) => (
        <table key={court}>
          <caption>{court ? t("contest.court", { court }) : t("office.paper.noCourt")}</caption>
          <thead>
            <tr>
              <th scope="col">{t("office.time")}</th>
              <th scope="col">{t("office.left")}</th>
              <th scope="col">{t("office.right")}</th>
              <th scope="col">{t("office.result")}</th>
              <th scope="col">{t("office.match")}</th>
            </tr>
          </thead>
          <tbody>
            {played.map(({ pairing, game, at_ms, teams, scores }) => (
              <tr key={`${pairing}/${game}`}>
                <td class="number">{at_ms > 0 && timeOf(at_ms)}</td>
                <th scope="row">{teams[0]}</th>
                <th scope="row">{teams[1]}</th>
                <td class="number">{scores.join(" : ")}</td>
                <td>{gameTitle(sheet, pairing, game)}</td>
              </tr>
            ))}
            {slots.map(({ pairing, at_ms, teams, who, fixture }) => (
              <tr key={pairing}>
                <td class="number">{timeOf(at_ms)}</td>
                <th scope="row">{who ? said(who[0]) : teams[0]}</th>
                <th scope="row">{who ? said(who[1]) : teams[1]}</th>
                <td />
                <td>{said(fixture)}</td>
              </tr>
            ))}
          </tbody>
        </table>
      ))}
    </section>
  );
}

/** All tables and all results. */
function Results({ sheet }: { sheet: ContestSheet }) {
  return (
    <section class="sheet-of-paper contest">
      <h1>{sheet.name}</h1>
      {sheet.stages.toReversed().map((view) => (
        <section key={view.stage.name}>
          <h2>{stageTitle(sheet, view.stage.name)}</h2>
          <Tables view={view} />
          <Schedule sheet={sheet} view={view} />
        </section>
      ))}
    </section>
  );
}

/** A certificate for each team that has its final place. */
function Certificates({ sheet }: { sheet: ContestSheet }) {
  const all = places(sheet);
  if (!all.length) return <p class="muted">{t("office.paper.noPlaces")}</p>;
  return (
    <>
      {all.map(({ team, rank, equal, stage, group, won }) => (
        <Certificate
          key={team}
          of={sheet.name}
          title={t("office.certificate")}
          who={team}
          isWon={won}
        >
          {won && !equal.length ? t("contest.winner") : placeTitle(rank, equal)}
          {stage && (
            <small>
              {" "}
              {stageTitle(sheet, stage)}
              {group && ` · ${t("contest.group", { group: group.toUpperCase() })}`}
            </small>
          )}
        </Certificate>
      ))}
    </>
  );
}

/** Cards: the links of teams, and the address of /enter while entries are open; on another sheet those of staff and referees. */
function Links({ organiser, view }: { organiser: Organiser; view: OfficeView }) {
  const links = organiser.links.value;
  if (!links) return <p class="muted">{t("contest.loading")}</p>;
  return (
    <>
      <div class="cards">
        {view.event.open && (
          <Card qr={links.enter_qr} alt={t("office.qrEnter")} title={t("office.enterAt")}>
            <p class="address">{links.enter}</p>
            <p>
              {t("office.code")}: <b class="code">{view.code}</b>
            </p>
          </Card>
        )}
        {links.teams.map(({ team, link, qr }) => (
          <Card key={team} qr={qr} title={team}>
            <p>{t("office.link")}</p>
            <p class="address">{link}</p>
          </Card>
        ))}
        {links.seats.map(({ court, seat, link, qr }) => (
          <Card
            key={`seat ${court} ${seat}`}
            qr={qr}
            title={t("office.seatOf", { seat: seatName(seat), court })}
          >
            <p>{t("office.seatLink")}</p>
            <p class="address">{link}</p>
          </Card>
        ))}
      </div>
      <div class="cards apart">
        {links.staff.map(({ name, link, qr }) => (
          <Card key={`staff ${name}`} qr={qr} title={name}>
            <p>{t("office.staffLink")}</p>
            <p class="address">{link}</p>
          </Card>
        ))}
        {links.referees.map(({ court, link, qr }) => (
          <Card key={`court ${court}`} qr={qr} title={t("office.refereeOf", { court })}>
            <p>{t("office.refereeLink")}</p>
            <p class="address">{link}</p>
          </Card>
        ))}
      </div>
    </>
  );
}

interface CardProps {
  /** A QR code, as SVG. */
  qr: string;
  title: string;
  alt?: string;
  children: ComponentChildren;
}

/** A card to cut out and hand out. */
function Card({ qr, title, alt = t("office.qrOf", { team: title }), children }: CardProps) {
  return (
    <section class="card-of-paper">
      <img src={pictureUrl(qr)} alt={alt} />
      <div>
        <h2>{title}</h2>
        {children}
      </div>
    </section>
  );
}
