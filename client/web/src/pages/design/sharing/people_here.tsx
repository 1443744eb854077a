/** The others at the table, by name and colour. */

import { t } from "../../../i18n";
import { placeName } from "../names";
import type { Sheet } from "../table/sheet";
import { COLOURS } from "./colours";
import type { Group } from "./group";
import type { People } from "./people";
import "./people.css";

interface Props {
  people: People;
  group: Group;
  sheet: Sheet;
}

export function PeopleHere({ people, group, sheet }: Props) {
  const others = people.others.value;
  const table = sheet.table.value;
  if (!others.length || !table) return null;
  return (
    <ul class="people" aria-label={t("design.people.here")}>
      {others.map((person) => {
        const { id, row, col } = person;
        const name = people.name(person);
        const isSomewhere = table.rows[row] !== undefined;
        const at = isSomewhere ? `${name}: ${placeName(table, row, col)}` : name;
        return (
          <li key={id}>
            <button
              type="button"
              data-colour={(group.colour(person.name) || id) % COLOURS}
              title={at}
              aria-label={at}
              disabled={!isSomewhere}
              onClick={() => sheet.select({ row, col })}
            >
              {name}
            </button>
          </li>
        );
      })}
    </ul>
  );
}
