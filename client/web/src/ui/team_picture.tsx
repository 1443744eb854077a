/** The picture of a team of a contest; nothing, or its first letter, if it gave none. */

import { ownPage } from "../core/address";
import type { ContestSheet } from "../core/contest/sheet";
import "./team_picture.css";

interface Props {
  sheet: ContestSheet | null;
  /** The team's name. */
  team: string;
  /** Where teams stand side by side, one without a picture has its first letter. */
  withLetter?: boolean;
}

/** An ornament: the name stands beside it. */
export function TeamPicture({ sheet, team, withLetter = false }: Props) {
  const there = sheet?.teams.find(({ name }) => name === team);
  if (!there?.picture) {
    return withLetter ? (
      <i class="team-picture" aria-hidden="true">
        {[...team][0]}
      </i>
    ) : null;
  }
  const address = ownPage ? `entries/${there.files}/picture.webp` : `pictures/${there.files}.webp`;
  return (
    <img
      key={address}
      class="team-picture"
      src={address}
      alt=""
      // In a published folder the files of teams come when entries are closed.
      onError={({ currentTarget }) => {
        currentTarget.hidden = true;
      }}
    />
  );
}
