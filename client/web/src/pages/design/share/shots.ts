/** A picture and a film of a trial, from the view that draws it. */

import type { Tried } from "../trials/tried";
import type { Showing } from "../walk/showing";

const FILM_HZ = 30;
const FILM_BITS_S = 4_000_000;
const KINDS = ["video/mp4;codecs=avc1.42E01F", "video/webm;codecs=vp9", "video/webm"];
/** A moment of standing at the end. */
const AFTER_MS = 400;

/** Takes what was just drawn. */
type Take = (view: HTMLCanvasElement) => void;

/** Whether this browser can film. */
export const canFilm = () => "MediaRecorder" in globalThis && kindOf() !== undefined;

export class Shots {
  private readonly takes = new Set<Take>();

  /** The view has drawn: only now its canvas can be read. */
  readonly drawn: Take = (view) => {
    for (const take of this.takes) take(view);
  };

  /** Take a picture of what is drawn next: PNG. */
  async picture(): Promise<Blob | null> {
    const canvas = document.createElement("canvas");
    await this.next(canvas);
    return new Promise((resolve) => canvas.toBlob(resolve));
  }

  /** Film a trial from its first press to its end; it takes as long as the trial. */
  async film(showing: Showing, tried: Tried): Promise<Blob> {
    const canvas = document.createElement("canvas");
    showing.look(tried);
    await this.next(canvas);
    const recorder = new MediaRecorder(canvas.captureStream(FILM_HZ), {
      mimeType: kindOf()!,
      videoBitsPerSecond: FILM_BITS_S,
    });
    const parts: Blob[] = [];
    recorder.ondataavailable = ({ data }) => parts.push(data);
    const stopped = new Promise((resolve) => {
      recorder.onstop = resolve;
    });
    // One size for all pictures: the view draws more coarsely where it is too slow.
    const copy: Take = (view) => draw(view, canvas);
    this.takes.add(copy);
    recorder.start();
    showing.playback.speed.value = 1;
    showing.look(tried);
    await ended(showing);
    await new Promise((resolve) => setTimeout(resolve, AFTER_MS));
    recorder.stop();
    await stopped;
    this.takes.delete(copy);
    return new Blob(parts, { type: recorder.mimeType.split(";")[0]! });
  }

  /** Take the next picture into a canvas, which gets its size. */
  private next(canvas: HTMLCanvasElement): Promise<void> {
    return new Promise((resolve) => {
      const take: Take = (view) => {
        this.takes.delete(take);
        canvas.width = view.width & ~1; // encoders want even numbers
        canvas.height = view.height & ~1;
        draw(view, canvas);
        resolve();
      };
      this.takes.add(take);
    });
  }
}

function draw(view: HTMLCanvasElement, canvas: HTMLCanvasElement): void {
  canvas.getContext("2d")!.drawImage(view, 0, 0, canvas.width, canvas.height);
}

/** Wait until a trial was played to its end, or stopped. */
function ended({ playback }: Showing): Promise<void> {
  return new Promise((resolve) => {
    const end = playback.playing.subscribe((isPlaying) => {
      // `end` is known only when `subscribe` has returned.
      if (!isPlaying) queueMicrotask(() => resolve(end()));
    });
  });
}

function kindOf(): string | undefined {
  return KINDS.find((kind) => MediaRecorder.isTypeSupported(kind));
}
