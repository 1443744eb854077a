/** Lets views draw one moment at a time, for a film: no picture depends on this machine's speed. */

/** A view that draws when it is told to. */
export interface Exposed {
  /** Resolves when the view can draw. */
  prepare(): Promise<void>;
  /** Go on to a time; draw it if it is wanted. */
  expose(nowMs: number, drawn: boolean): void;
  /** Begin a new shot: cameras and movements forget what was before. */
  cut(): void;
}

/** Says when views draw and for which time, in place of the browser's animation frames. */
export class Shutter {
  private readonly views = new Set<Exposed>();

  /** @param smooth Whether edges are smooth also in low quality, although that takes much time. */
  constructor(readonly smooth: boolean) {}

  add(view: Exposed): void {
    this.views.add(view);
  }

  remove(view: Exposed): void {
    this.views.delete(view);
  }

  /** How many views there are. */
  get count(): number {
    return this.views.size;
  }

  /** Resolves when all views can draw. */
  async prepare(): Promise<void> {
    await Promise.all([...this.views].map((view) => view.prepare()));
  }

  /**
   * Let all views go on to a time.
   *
   * The automatic camera and what moves depend on the times before. So each page is told all times
   * of the film in order, also those that another page draws.
   *
   * @param nowMs Time of the film.
   * @param drawn False: only go on, which costs little.
   */
  expose(nowMs: number, drawn: boolean): void {
    for (const view of this.views) view.expose(nowMs, drawn);
  }

  /** Begin a new shot. */
  cut(): void {
    for (const view of this.views) view.cut();
  }
}
