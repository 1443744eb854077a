/** What each step of the lesson shows: its picture, and what can be changed there. */

import type { ComponentType } from "preact";
import { bodyWay } from "../../core/leg/leg";
import { feetOf, type StepName } from "../../core/leg/lesson";
import { margin } from "../../core/leg/stance";
import { t } from "../../i18n";
import { RobotAbove, Swing, Turned } from "./above";
import { Behind } from "./behind";
import { Joints, Pairs, Slider } from "./controls";
import { FootFormula, KneeFormula, SwingFormula } from "./formulas";
import type { Lesson } from "./lesson";
import { Table } from "./table";

interface Props {
  lesson: Lesson;
}

interface Shown {
  Picture: ComponentType<Props>;
  /** What appears when all is guessed. */
  More: ComponentType<Props> | null;
}

export const SHOWN: Readonly<Record<StepName, Shown>> = {
  joints: {
    Picture: ({ lesson }) => {
      const robot = lesson.robot.value;
      const legs = robot.legs.length;
      const isShown = lesson.isShown();
      const second = lesson.answerOf(0) !== null;
      const lit = isShown ? 2 * legs + 1 : second ? legs : null;
      // Until all is guessed, only the numbers of what was asked.
      const numbers = isShown ? null : second ? [0, legs] : [0];
      return <RobotAbove robot={robot} numbers={numbers} lit={lit} />;
    },
    More: null,
  },
  knee: {
    Picture: ({ lesson }) => {
      const [, first] = lesson.angles.value;
      const triangles = lesson.isShown() ? 1 : 0;
      const robot = lesson.robot.value;
      return (
        <Behind robot={robot} first={first} second={0} triangles={triangles} hasShank={false} />
      );
    },
    More: ({ lesson }) => (
      <>
        <KneeFormula leg={lesson.leg.value} first={lesson.angles.value[1]} />
        <Joints lesson={lesson} levels={[1]} />
      </>
    ),
  },
  foot: {
    Picture: ({ lesson }) => {
      const [, first, second] = lesson.angles.value;
      const triangles = lesson.isShown() ? 2 : 0;
      const robot = lesson.robot.value;
      return <Behind robot={robot} first={first} second={second} triangles={triangles} />;
    },
    More: ({ lesson }) => (
      <>
        <Foot lesson={lesson} />
        <Joints lesson={lesson} levels={[1, 2]} />
      </>
    ),
  },
  swing: {
    Picture: ({ lesson }) => (
      <Swing r={lesson.foot.value.r} swing={lesson.swing.value} isShown={lesson.isShown()} />
    ),
    More: ({ lesson }) => {
      const [r, swing] = [lesson.foot.value.r, lesson.swing.value];
      return (
        <>
          <SwingFormula r={r} swing={swing} />
          <p>{t("leg.swing.way", { way: bodyWay(r, swing) })}</p>
          <Slider
            name={t("leg.swingWidth")}
            value={swing}
            low={0}
            high={120}
            onChange={(angle) => {
              lesson.swing.value = angle;
            }}
          />
        </>
      );
    },
  },
  back: {
    Picture: ({ lesson }) => <ToDrag lesson={lesson} hasArea={false} />,
    More: ({ lesson }) => (
      <>
        <Foot lesson={lesson} />
        <Pairs lesson={lesson} />
      </>
    ),
  },
  reach: {
    Picture: ({ lesson }) => <ToDrag lesson={lesson} hasArea={lesson.isShown()} />,
    More: ({ lesson }) => <Pairs lesson={lesson} />,
  },
  stand: {
    Picture: ({ lesson }) => (
      <RobotAbove
        robot={lesson.robot.value}
        down={lesson.down.value}
        hasArea={lesson.answerOf(0) !== null}
      />
    ),
    More: ({ lesson }) => <Stand lesson={lesson} />,
  },
  table: {
    Picture: ({ lesson }) => {
      const [root, first, second] = lesson.angles.value;
      const robot = lesson.robot.value;
      return (
        <>
          <Behind robot={robot} first={first} second={second} triangles={2} isWide />
          <Turned r={lesson.foot.value.r} root={root} />
        </>
      );
    },
    More: ({ lesson }) => <Table lesson={lesson} />,
  },
};

function Foot({ lesson }: Props) {
  const [, first, second] = lesson.angles.value;
  return <FootFormula leg={lesson.leg.value} first={first} second={second} />;
}

function ToDrag({ lesson, hasArea }: { lesson: Lesson; hasArea: boolean }) {
  const [, first, second] = lesson.angles.value;
  const { postures, unreached } = lesson.found.value;
  const isShown = lesson.isShown();
  const isBack = lesson.step.value.name === "back";
  return (
    <Behind
      robot={lesson.robot.value}
      first={first}
      second={second}
      triangles={isShown && isBack && !unreached ? 2 : 0}
      others={isShown ? postures.filter(([one]) => one !== first) : []}
      target={isShown || isBack ? lesson.spot.value : null}
      isReached={!isShown || !unreached}
      hasArea={hasArea}
      isWide
      onDrag={isShown ? (spot) => lesson.bring(spot) : undefined}
    />
  );
}

function Stand({ lesson }: Props) {
  const robot = lesson.robot.value;
  const feet = feetOf(robot);
  const down = lesson.down.value;
  const found = margin([...down].map((leg) => feet[leg]!));
  return (
    <div class="stand">
      <p>{t("leg.stand.try")}</p>
      <div class="choices">
        {robot.legs.map(({ label }, leg) => (
          <button
            key={label}
            class="button"
            type="button"
            aria-pressed={down.has(leg)}
            onClick={() => {
              const now = new Set(down);
              if (!now.delete(leg)) now.add(leg);
              lesson.down.value = now;
            }}
          >
            {label}
          </button>
        ))}
      </div>
      <p role="status">
        {found === null ? t("leg.stand.none") : t("leg.stand.margin", { margin: found })}
      </p>
    </div>
  );
}
