/** A team's name where room is short. */

const JAPANESE = /[\p{sc=Hira}\p{sc=Kana}\p{sc=Han}]/u;

interface Props {
  name: string;
}

/** It breaks between words; a word that is too long ends with "…", and the title has it all. */
export function TeamName({ name }: Props) {
  return (
    <span class="team-name" title={name} lang={JAPANESE.test(name) ? "ja" : undefined}>
      {name}
    </span>
  );
}
