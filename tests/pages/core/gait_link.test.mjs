// Tests of gaits in addresses (client/web/src/core/design/gait_link.ts).

import assert from "node:assert/strict";
import { test } from "node:test";
import { fragmentOf, gaitIn, hasGait } from "../../../client/web/src/core/design/gait_link.ts";

const GAIT = {
  name: "Loco-data.txt",
  gait: `Key\t0\t1\n${"0\t45\t-45\n".repeat(60)}`,
  robot: { name: "robot.toml", text: 'name = "あり"\n' },
  sequences: [[0], [8, 7, 6, 5]],
  key: 2,
};
const packed = async (value) => {
  const bytes = new Blob([JSON.stringify(value)]).stream();
  const whole = await new Response(bytes.pipeThrough(new CompressionStream("deflate-raw"))).bytes();
  return `#gait=${Buffer.from(whole).toString("base64url")}`;
};

test("a gait comes back from an address, wherever in a text it stands", async () => {
  const fragment = await fragmentOf(GAIT);
  assert.ok(fragment.length < 400, fragment);
  for (const text of [
    fragment,
    `Look: http://x.example/design${fragment} !`,
    fragment.replace("#", "#key=a&"),
  ]) {
    assert.ok(hasGait(text));
    assert.deepEqual(await gaitIn(text), GAIT);
  }
  const plain = { ...GAIT, robot: null, sequences: null };
  assert.deepEqual(await gaitIn(await fragmentOf(plain)), plain);
});

test("what is no gait is none", async () => {
  assert.equal(hasGait("0\t45\t-45"), false);
  const whole = await fragmentOf(GAIT);
  const wrong = [
    "",
    "#gait=",
    whole.slice(0, -9),
    `#gait=${"A".repeat(200_000)}`,
    await packed(null),
    await packed([]),
    await packed({ ...GAIT, gait: 1 }),
    await packed({ ...GAIT, key: 10 }),
    await packed({ ...GAIT, key: 1.5 }),
    await packed({ ...GAIT, robot: { name: "r" } }),
    await packed({ ...GAIT, sequences: [["a"]] }),
    await packed({ ...GAIT, sequences: Array(11).fill([0]) }),
  ];
  for (const text of wrong) assert.equal(await gaitIn(text), null, text.slice(0, 80));
});

test("a link that would unpack to far too much is refused while it is unpacked", async () => {
  assert.equal(await gaitIn(await packed({ ...GAIT, gait: "0".repeat(30_000_000) })), null);
});
