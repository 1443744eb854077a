/** What the page knows, by nouns, and how the nouns hear of each other. */

import { computed, signal } from "@preact/signals";
import type { Refused } from "../../core/connection";
import { type Shown, source } from "../../core/design/sources";
import type { Phrase } from "../../core/phrase";
import type { Message } from "../../core/wire";
import { ALL, type Can } from "./can";
import { Handed } from "./class/handed";
import { type Greeting, Membership } from "./class/membership";
import { Coach } from "./coach/coach";
import { Others } from "./coach/others";
import { Search } from "./coach/search";
import { Court } from "./files/court";
import { Files } from "./files/files";
import { sentGait } from "./files/gait";
import { Opening } from "./files/opening";
import { Gateway } from "./gateway";
import { hasEarned, Learning } from "./learning/learning";
import { Numbers } from "./robot/numbers";
import { RobotInUse } from "./robot/robot";
import { Friend } from "./share/friend";
import { Shots } from "./share/shots";
import { Group } from "./sharing/group";
import { People } from "./sharing/people";
import { Sharing } from "./sharing/sharing";
import { takeGivenLeg } from "./table/given_leg";
import { Sheet } from "./table/sheet";
import { Trials } from "./trials/trials";
import { Showing } from "./walk/showing";

const ASK_AGAIN_MS = 2000;

export class Studio {
  readonly can = signal<Can>(ALL);
  /** Whether a studio answers; null: not known yet. */
  readonly present = signal<boolean | null>(null);
  /** Why no studio answers. */
  readonly why = signal<Phrase | null>(null);

  readonly membership = new Membership();
  readonly gateway = new Gateway(
    () => this.greet(),
    (message) => this.take(message),
  );
  readonly robot = new RobotInUse(this.gateway);
  readonly showing = new Showing();
  readonly sheet: Sheet = new Sheet(
    {
      before: (by) => this.learning.tell(by),
      changed: (by, size) => this.learning.edited(by, size),
      turned: (before, now) => this.files.shapes.turned(before, now),
      guard: (before, after) => this.group.guard(before, after),
      merged: (before, now) => this.learning.merged(before, now),
      legsChanged: () => this.trials.forget(),
      worked: () => this.showing.rest(),
    },
    this.robot.used,
  );
  readonly learning: Learning = new Learning(
    this.gateway,
    (table) => sentGait(this.sheet, this.robot, table),
    () => this.sheet.table.peek(),
  );
  readonly trials: Trials = new Trials(
    this.gateway,
    this.sheet,
    this.robot,
    this.learning,
    this.showing,
  );
  readonly search = new Search(this.gateway);
  readonly coach = new Coach(
    this.search,
    new Others(this.search, this.sheet, this.robot, this.trials),
    this.sheet,
    this.robot,
    this.trials,
  );
  readonly files: Files = new Files(this.gateway, this.sheet, this.robot, this.can);
  readonly people = new People(this.gateway, this.sheet, this.membership);
  readonly sharing: Sharing = new Sharing(
    this.gateway,
    this.sheet,
    this.robot,
    this.files.file,
    () => this.membership.name.peek() ?? "",
    (places, by) => this.people.clashed(places, by),
  );
  readonly group: Group = new Group(this.gateway, this.sheet, this.sharing, this.membership);
  readonly numbers = new Numbers(this.robot, this.files);
  readonly court = new Court(this.gateway, this.sheet, this.robot);
  readonly handed = new Handed(this.membership, this.group, this.files);
  readonly shots = new Shots();
  readonly friend = new Friend(this.gateway, this.sheet, this.robot, this.files, this.trials);

  /** What the picture shows. */
  readonly picture = source(
    computed(() => {
      const { watching, shown } = this.showing;
      return (watching.value && shown.value?.robot) || this.robot.robot.value;
    }),
    computed<Shown | null>(() => {
      const { watching, shown, tick } = this.showing;
      if (watching.value && shown.value) return { trial: shown.value.trial, tick: tick.value };
      const cells = this.sheet.posture.value;
      return cells && { cells };
    }),
  );

  readonly opening = new Opening(
    this.gateway,
    this.files,
    this.robot,
    this.sheet,
    this.sharing,
    () => this.trials.all.peek().length > 0,
  );
  /** The timer after which the first things are asked for again. */
  private asksAgain = 0;
  /** null: not greeted yet. */
  private greeting: Greeting | null = null;

  private async greet(): Promise<void> {
    let greeting: Greeting;
    try {
      greeting = await this.gateway.ask<Greeting>("hello", this.membership.shown());
    } catch (error) {
      this.membership.refused(error as Refused);
      throw error;
    }
    const before = this.greeting?.student;
    this.membership.entered(greeting);
    if (before !== undefined && before !== greeting.student) {
      // What is on the page is somebody else's: nothing of it may go out.
      this.gateway.end();
      location.reload();
      return;
    }
    const { student, table, earned } = greeting;
    this.sharing.greet(table);
    this.people.greet();
    this.court.leads.value = greeting.court;
    this.greeting = greeting;
    const isAlone = student === null;
    this.can.value = { ...this.can.peek(), save: isAlone, sample: isAlone || earned };
    if (this.opening.isOpen) {
      this.learning.greet();
      this.trials.goOn();
    } else void this.openFirst();
  }

  private take({ kind, body }: Message): void {
    if (kind === "studio") {
      this.present.value = body.present;
      this.why.value = body.why;
      void this.openFirst();
    } else if (kind === "phases") {
      const before = this.learning.phases.peek()?.phase;
      this.learning.phases.value = body;
      const can = this.can.peek();
      if (body.phase !== before && can.learn) this.trials.suit(body.phase);
      const sample = can.save || hasEarned(body);
      this.can.value = { ...can, rules: body.rules, sample };
    } else if (kind === "progress") {
      this.search.progress.value = body;
    } else if (kind === "handed") {
      this.handed.newest.value = body;
    } else if (kind === "table") {
      this.sharing.take(body);
    } else if (kind === "group") {
      this.group.news.value = body;
    } else if (kind === "people") {
      this.people.take(body);
    } else if (kind === "forgotten") {
      this.gateway.end();
      this.trials.forget();
      this.membership.isForgotten.value = true;
    } else if (kind === "folder") {
      const { folder, files, changed } = body;
      this.files.folder.value = { folder, files };
      void this.openFirst();
      for (const name of changed) void this.opening.changed(name);
    }
  }

  /** Open the first things to see, as soon as there is a studio that knows robots. */
  private async openFirst(): Promise<void> {
    if (!this.greeting || !this.present.peek() || this.opening.isOpen) return;
    await this.opening.first(this.greeting);
    if (this.opening.isOpen) {
      this.learning.greet();
      takeGivenLeg(this.sheet);
      const { student } = this.greeting;
      void this.trials.comeBack(student ?? `folder ${this.files.folder.peek().folder}`);
    }
    clearTimeout(this.asksAgain);
    if (this.opening.waitsFor.peek()) {
      this.asksAgain = window.setTimeout(() => void this.openFirst(), ASK_AGAIN_MS);
    }
  }
}
