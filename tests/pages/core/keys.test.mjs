// Tests of what a key of the keyboard means (client/web/src/core/keys.ts).

import assert from "node:assert/strict";
import { test } from "node:test";
import { nameOfKey, readKey } from "../../../client/web/src/core/keys.ts";

const key = (code, held = {}) => readKey({ code, key: "Process", keyCode: 229, ...held });

test("each action has a key of its own (rules 3)", () => {
  const does = Object.fromEntries(
    ["KeyX", "KeyZ", "KeyR", "Tab", "Space"].map((code) => [code, key(code).does]),
  );
  assert.deepEqual(does, {
    KeyX: "restart",
    KeyZ: "leave",
    KeyR: "ready",
    Tab: "level",
    Space: "view",
  });
});

test("digits and arrows are known by their place, whatever they type", () => {
  assert.deepEqual(key("Digit7"), { does: "digit", digit: 7 });
  assert.deepEqual(key("Numpad7"), { does: "digit", digit: 7 });
  const arrows = ["ArrowUp", "ArrowLeft", "ArrowRight", "ArrowDown"];
  assert.deepEqual(
    arrows.map((code) => key(code).digit),
    [2, 1, 3, 0],
  );
});

test("letters and signs are known by what they type", () => {
  const typed = (code, text) => key(code, { key: text, keyCode: 0 });
  assert.equal(typed("KeyY", "z").does, "leave"); // QWERTZ
  assert.equal(typed("KeyZ", "y"), null);
  assert.equal(typed("KeyB", "X").does, "restart"); // Dvorak, Caps Lock
  assert.equal(typed("KeyZ", "я").does, "leave"); // a keyboard without z
  assert.deepEqual(typed("Digit6", "-"), { does: "digit", digit: 6 }); // AZERTY
  const names = [
    ["Semicolon", "+", "Equal"], // JIS
    ["Minus", "ß", "ß"],
    ["Slash", "-", "Minus"],
    ["KeyM", ",", "Comma"], // AZERTY
    ["Comma", ";", ";"],
    ["Comma", "Process", "Comma"],
  ];
  for (const [code, text, name] of names) assert.equal(nameOfKey({ code, key: text }), name);
});

test("what a program types for a person counts, though it has no place", () => {
  assert.deepEqual(key("", { key: "7" }), { does: "digit", digit: 7 });
  assert.equal(key("", { key: "ArrowUp" }).digit, 2);
  assert.equal(key("", { key: " " }).does, "view");
});

test("the browser's own keys stay its own", () => {
  for (const held of ["ctrlKey", "altKey", "metaKey"]) {
    assert.equal(key("KeyR", { [held]: true }), null);
  }
  assert.equal(key("Tab", { shiftKey: true }), null);
  assert.equal(key("KeyK"), null);
});
