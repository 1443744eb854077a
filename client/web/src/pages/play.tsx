/** A contestant's page (workshop 5-4, Figs. 5-6 to 5-10). */

import { Cockpit } from "./player/cockpit";

export default function Play() {
  return <Cockpit alone={false} />;
}
