/** Where somebody is in the lesson: step, guesses, and the posture of the leg. */

import { batch, computed, signal } from "@preact/signals";
import { bent, type Spot, spots, type Three } from "../../core/leg/leg";
import { farSpot, KNEE_DEG, lesson, SWING_DEG, standing, startOf } from "../../core/leg/lesson";
import { SAMPLES } from "../../core/leg/samples.gen";

const WORKSHOPS_ROBOT = "hexapod";

/** What is done in the lesson: somebody came to a step, or answered a question of it. */
export interface Done {
  /** From 1. */
  step: number;
  robot: string;
  /** null: came to the step. */
  question: number | null;
  /** How many questions the step has. */
  of: number;
  choice: number;
  right: boolean;
}

export class Lesson {
  readonly robotName = signal(WORKSHOPS_ROBOT);
  readonly robot = computed(() => SAMPLES[this.robotName.value]!);
  readonly leg = computed(() => this.robot.value.legs[0]!);
  readonly steps = computed(() => lesson(this.robot.value));
  readonly at = signal(0);
  readonly step = computed(() => this.steps.value[this.at.value]!);
  /** The chosen answer of each question, by robot, step and question. */
  private readonly answers = signal<Readonly<Record<string, number>>>({});
  /** Root, 1st and 2nd [deg]. */
  readonly angles = signal<Three>([0, 0, 0]);
  /** Where the foot shall be. */
  readonly spot = signal<Spot>({ r: 0, z: 0 });
  /** Which of two pairs of angles is shown. */
  readonly bend = signal(0);
  readonly found = computed(() => bent(this.leg.value, this.spot.value));
  /** How far Root swings [deg]. */
  readonly swing = signal(SWING_DEG);
  /** The legs that stand. */
  readonly down = signal<ReadonlySet<number>>(new Set());
  /** Where the foot is. */
  readonly foot = computed(() => {
    const [, first, second] = this.angles.value;
    return spots(this.leg.value, first, second)[2];
  });

  /** Hears of all that is done. */
  follower: ((done: Done) => void) | null = null;

  constructor() {
    this.goTo(this.named());
  }

  /** Where the lesson is now. */
  here(): Done {
    const [step, robot] = [this.at.peek() + 1, this.robotName.peek()];
    return { step, robot, question: null, of: 0, choice: 0, right: false };
  }

  /**
   * Take up the lesson where it was left: all answers, and, unless the address names a step or
   * something was answered here, the last step.
   */
  takeUp(steps: readonly Done[]): void {
    const last = steps.at(-1);
    if (!last) return;
    batch(() => {
      const isFresh = !location.hash && !Object.keys(this.answers.peek()).length;
      const answers: Record<string, number> = {};
      for (const { step, robot, question, choice } of steps) {
        if (question !== null) answers[`${robot}/${step - 1}/${question}`] = choice;
      }
      this.answers.value = { ...answers, ...this.answers.peek() };
      if (isFresh && SAMPLES[last.robot]) this.robotName.value = last.robot;
      const step = isFresh ? last.step - 1 : this.at.peek();
      this.show(this.steps.peek()[step] ? step : 0);
    });
  }

  /** Ask the questions of this step again. */
  askAgain(): void {
    batch(() => {
      const own = this.name(0, this.at.peek()).replace(/0$/, "");
      const others = Object.entries(this.answers.peek()).filter(([name]) => !name.startsWith(own));
      this.answers.value = Object.fromEntries(others);
      this.begin();
    });
  }

  /** Go to the step that the address names, if it is another one. */
  follow(): void {
    if (this.named() !== this.at.peek()) this.goTo(this.named());
  }

  /** The step that the address names: "#3"; the first one if it names none. */
  private named(): number {
    const step = Number(location.hash.slice(1)) - 1;
    return Number.isInteger(step) && this.steps.peek()[step] ? step : 0;
  }

  choose(robot: string): void {
    batch(() => {
      this.robotName.value = robot;
      this.goTo(this.at.peek());
    });
  }

  goTo(step: number): void {
    this.show(step);
    this.follower?.(this.here());
  }

  /** The chosen answer; null: none yet. */
  answerOf(question: number, step = this.at.value): number | null {
    return this.answers.value[this.name(question, step)] ?? null;
  }

  answer(question: number, choice: number): void {
    batch(() => {
      const name = this.name(question, this.at.peek());
      this.answers.value = { ...this.answers.peek(), [name]: choice };
      this.begin();
    });
    const { questions } = this.step.peek();
    const right = questions[question]?.choices[choice]?.right ?? false;
    this.follower?.({ ...this.here(), question, of: questions.length, choice, right });
  }

  /** Whether all questions of a step are answered, so that it may show everything. */
  isShown(step = this.at.value): boolean {
    return this.steps.value[step]!.questions.every((_, at) => this.answerOf(at, step) !== null);
  }

  /** Turn one joint. */
  turn(level: 0 | 1 | 2, angle: number): void {
    this.angles.value = this.angles.peek().with(level, angle) as unknown as Three;
  }

  /** Bring the foot to a spot; where it can't come, the leg stays. */
  bring(spot: Spot): void {
    batch(() => {
      this.spot.value = spot;
      this.takePair(this.bend.peek());
    });
  }

  /** Show one of the pairs of angles; if there is only one, that. */
  takePair(bend: number): void {
    batch(() => {
      this.bend.value = bend;
      const { postures } = this.found.peek();
      const pair = postures[bend] ?? postures[0];
      if (pair) this.angles.value = [this.angles.peek()[0], ...pair];
    });
  }

  private show(step: number): void {
    batch(() => {
      this.at.value = step;
      this.begin();
      if (step > 0 || location.hash) history.replaceState(null, "", `#${step + 1}`);
    });
  }

  private name(question: number, step: number): string {
    return `${this.robotName.value}/${step}/${question}`;
  }

  /** The posture with which a step begins: what is asked shows itself only after the answer. */
  private begin(): void {
    const { name } = this.step.peek();
    const robot = this.robot.peek();
    const [, first, second] = startOf(robot);
    const isShown = this.isShown(this.at.peek());
    if (name === "knee") this.angles.value = [0, isShown ? KNEE_DEG : 0, 0];
    if (name === "foot") this.angles.value = isShown ? [0, first, second] : [0, 0, 0];
    if (name === "swing") this.angles.value = [0, first, second];
    if (name === "swing") this.swing.value = SWING_DEG;
    if (name === "stand") {
      const sets = standing(robot);
      const answered = sets.filter((_, at) => this.answerOf(at, this.at.peek()) !== null);
      this.down.value = new Set(answered.at(-1) ?? sets[0]);
    }
    if (name === "table" && this.angles.peek().every((angle) => !angle)) {
      this.angles.value = startOf(robot);
    }
    if (name !== "back" && name !== "reach") return;
    this.angles.value = [0, 0, 0];
    this.spot.value = farSpot(robot);
    if (isShown) this.bring(this.spot.peek());
  }
}
