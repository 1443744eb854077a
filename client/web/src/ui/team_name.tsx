/** A team's name where room is short. */

const JAPANESE = /[\p{sc=Hira}\p{sc=Kana}\p{sc=Han}]/u;

/** The language by which a name breaks between words on a page of any language. */
export function languageOf(name: string): "ja" | undefined {
  return JAPANESE.test(name) ? "ja" : undefined;
}

interface Props {
  name: string;
}

/** It breaks between words; a word that is too long ends with "…", and the title has it all. */
export function TeamName({ name }: Props) {
  return (
    <span class="team-name" title={name} lang={languageOf(name)}>
      {name}
    </span>
  );
}
