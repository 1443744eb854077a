/** What is printed; the browser can also print it into a PDF. */

import type { ComponentChildren } from "preact";
import { language, t } from "../i18n";
import "./papers.css";

interface Props {
  /** Names the paper. */
  paper: string;
  /** What the reader should know before printing. */
  hint: string;
  onBack: () => void;
  children: ComponentChildren;
}

/** Paper on the screen, with the buttons to go back and to print. */
export function Papers({ paper, hint, onBack, children }: Props) {
  return (
    <main class="papers" data-paper={paper}>
      <div class="paper-tools">
        <button class="button" type="button" onClick={onBack}>
          {t("office.paper.back")}
        </button>
        <button class="button strong" type="button" onClick={() => print()}>
          {t("contest.print")}
        </button>
        <p class="muted">{hint}</p>
      </div>
      {children}
    </main>
  );
}

interface CertificateProps {
  /** The event. */
  of: string;
  title: string;
  who: ComponentChildren;
  isWon?: boolean;
  /** What it was given for. */
  children: ComponentChildren;
}

/** A page to hang up, with the date of today and a line for a signature. */
export function Certificate({ of, title, who, isWon, children }: CertificateProps) {
  const day = new Date().toLocaleDateString(language.value, { dateStyle: "long" });
  return (
    <section class="certificate" data-won={isWon || undefined}>
      <p class="of">{of}</p>
      <h1>{title}</h1>
      <p class="team">{who}</p>
      <p class="place">{children}</p>
      <footer>
        <span>{day}</span>
        <span class="signature">{t("office.signature")}</span>
      </footer>
    </section>
  );
}
