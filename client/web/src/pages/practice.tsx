/** One robot on a floor of its own (workshop 4-4, Fig. 4-3). */

import { Cockpit } from "./player/cockpit";

export default function Practice() {
  return <Cockpit alone={true} />;
}
