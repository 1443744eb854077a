/** Where to go: the ways into the contest. */

import { setting } from "../core/address";
import { type MessageName, t } from "../i18n";
import "./home.css";

const WAYS = [
  "watch",
  "contest",
  "play",
  "practice",
  "referee",
  "replay",
  "overlay",
  "leg",
] as const;

export default function Home() {
  const court = setting("court");
  return (
    <main class="home">
      <h1>LACOC</h1>
      <p class="muted">{t("home.title")}</p>
      <nav>
        {WAYS.map((way) => (
          <a key={way} class="button" href={`${way}${court ? `?court=${court}` : ""}`}>
            {t(`home.${way}` as MessageName)}
          </a>
        ))}
      </nav>
    </main>
  );
}
