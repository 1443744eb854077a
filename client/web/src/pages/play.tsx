/** A contestant's page (workshop 5-4, Figs. 5-6 to 5-10). */

import { Cockpit } from "./player/cockpit";

export default function Play() {
  return <Cockpit alone={false} />;
}

/** One robot on a floor of its own (workshop 4-4, Fig. 4-3). */
export function Practice() {
  return <Cockpit alone={true} />;
}
