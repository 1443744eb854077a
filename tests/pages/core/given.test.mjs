// Tests of files in a fragment (client/web/src/core/given.ts).

import assert from "node:assert/strict";
import { test } from "node:test";
import { encode } from "../../../client/web/node_modules/@msgpack/msgpack/dist.esm/index.mjs";
import { enterPage, fragmentOf, givenIn, hasGiven } from "../../../client/web/src/core/given.ts";

const file = (name, text) => ({ name, data: new TextEncoder().encode(text) });
const GIVEN = {
  files: {
    robot: file("robot.toml", 'name = "あり"\n'),
    postures: file("Loco-data.txt", `Key\t0\t1\n${"0\t45\t-45\n".repeat(60)}`),
    locomotion: null,
  },
  sequences: [[0], [8, 7, 6, 5]],
  key: 2,
};
const packed = async (value) => {
  const bytes = new Blob([encode(value)]).stream();
  const whole = new Response(bytes.pipeThrough(new CompressionStream("deflate-raw")));
  return `#files=${Buffer.from(await whole.arrayBuffer()).toString("base64url")}`;
};

test("files come back from an address, wherever in a text it stands", async () => {
  const fragment = await fragmentOf(GIVEN);
  assert.ok(fragment.length < 400, fragment);
  for (const text of [
    fragment,
    `Look: http://x.example/design${fragment} !`,
    fragment.replace("#", "#key=a&"),
  ]) {
    assert.ok(hasGiven(text));
    assert.deepEqual(await givenIn(text), GIVEN);
  }
  const odd = { name: "歩容 &=#.txt", data: Uint8Array.from([0, 255, 10, 13, 200]) };
  const other = { ...GIVEN, files: { ...GIVEN.files, postures: odd } };
  assert.deepEqual(await givenIn(await fragmentOf(other)), other);
  const plain = {
    files: { robot: null, postures: null, locomotion: null },
    sequences: null,
    key: null,
  };
  assert.deepEqual(await givenIn(await fragmentOf(plain)), plain);
});

test("what no page of ours wrote is nothing", async () => {
  assert.equal(hasGiven("0\t45\t-45"), false);
  const whole = await fragmentOf(GIVEN);
  const { files } = GIVEN;
  const wrong = [
    "",
    "#token=x",
    "#files=",
    "#files={",
    "#files=[1]",
    whole.slice(0, -9),
    `#files=${"A".repeat(500_000)}`,
    await packed(null),
    await packed([]),
    await packed({ ...GIVEN, files: null }),
    await packed({ ...GIVEN, files: { ...files, robot: { name: "r" } } }),
    await packed({ ...GIVEN, files: { ...files, robot: { name: 1, data: new Uint8Array() } } }),
    await packed({ ...GIVEN, files: { ...files, robot: { name: "r", data: "text" } } }),
    await packed({ ...GIVEN, files: { robot: null } }),
    await packed({ ...GIVEN, key: 10 }),
    await packed({ ...GIVEN, key: 1.5 }),
    await packed({ ...GIVEN, sequences: [["a"]] }),
    await packed({ ...GIVEN, sequences: Array(11).fill([0]) }),
  ];
  for (const text of wrong) assert.equal(await givenIn(text), null, text.slice(0, 80));
});

test("a link that would unpack to far too much is refused while it is unpacked", async () => {
  const huge = { ...GIVEN, files: { ...GIVEN.files, robot: file("r", "0".repeat(30_000_000)) } };
  assert.equal(await givenIn(await packed(huge)), null);
});

test("an address is read however it is typed", () => {
  for (const typed of ["192.168.1.20:8080", " http://192.168.1.20:8080/contest?big "]) {
    assert.equal(enterPage(typed), "http://192.168.1.20:8080/enter");
  }
  assert.equal(enterPage("https://cup.example"), "https://cup.example/enter");
  for (const typed of ["https://uni.example/cup", "https://uni.example/cup/play?court=north"]) {
    assert.equal(enterPage(typed), "https://uni.example/cup/enter");
  }
  for (const typed of ["", "  ", "http://"]) assert.equal(enterPage(typed), "");
});
