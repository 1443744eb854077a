/** A field for one number of the robot. */

import { useSignal } from "@preact/signals";
import { useId, useRef } from "preact/hooks";
import { numberOf } from "../../../core/design/table";
import type { RobotReply } from "../../../core/wire";
import type { Numbers } from "./numbers";
import { pairOf, type RobotNumber, textOf, unitOf } from "./units";

interface Props {
  numbers: Numbers;
  robot: RobotReply;
  number: RobotNumber;
  label: string;
  /** The number as it is; where legs differ, the lowest and the highest. */
  shown: string;
}

export function Field({ numbers, robot, number, label, shown }: Props) {
  const typed = useSignal<string | null>(null);
  const wrong = useSignal("");
  /** Counts the visits to the field: all steps of one visit are one step to undo. */
  const visit = useRef(0);
  const note = useId();
  const unit = unitOf(number.entry);

  const put = async (text: string) => {
    const why = await numbers.set(number, text, `${number.entry} ${number.leg} ${visit.current}`);
    if (typed.peek() !== text) return; // somebody typed on
    wrong.value = why ?? "";
    if (why === null) typed.value = null;
  };
  const keep = () => {
    if (typed.peek() !== null && !wrong.peek()) void put(typed.peek()!);
  };
  const cancel = () => {
    typed.value = null;
    wrong.value = "";
  };
  const step = (sign: number) => {
    const from =
      numberOf(typed.peek() ?? "") ?? pairOf(robot, number)[sign > 0 ? 1 : 0] * unit.times;
    const text = textOf((from + sign * unit.step) / unit.times, unit);
    wrong.value = "";
    typed.value = text;
    void put(text);
  };
  return (
    <>
      <input
        class="robot-number"
        data-kept={typed.value === null || undefined}
        inputMode="decimal"
        autoComplete="off"
        spellcheck={false}
        value={typed.value ?? shown}
        aria-label={unit.shown ? `${label} (${unit.shown})` : label}
        aria-invalid={wrong.value !== ""}
        aria-describedby={wrong.value ? note : undefined}
        onFocus={(event) => {
          visit.current++;
          event.currentTarget.select();
        }}
        onInput={(event) => {
          wrong.value = "";
          typed.value = event.currentTarget.value;
        }}
        onBlur={keep}
        onKeyDown={(event) => {
          if (event.isComposing || event.ctrlKey || event.metaKey) return;
          const act = {
            ArrowUp: () => step(1),
            ArrowDown: () => step(-1),
            Enter: keep,
            Escape: cancel,
          }[event.key];
          if (!act) return;
          event.preventDefault();
          event.stopPropagation();
          act();
        }}
      />
      {wrong.value && (
        <p class="wrong" id={note} role="alert">
          {wrong.value}
        </p>
      )}
    </>
  );
}
