/** Chooses the best quality that this machine can draw at an even rate. */

import { browser } from "../core/storage";

export type Fineness = "low" | "high";

/** A page feels slow beyond this. */
const SLOW_MS = 50;
/** Frames needed for a verdict; the first ones are slow because shaders compile. */
const WINDOW = 60;
const WARM_UP = 20;
const KEPT = "lacoc.fineness";

/** Times between frames. */
export class FrameTimes {
  private readonly times = new Float64Array(WINDOW);
  private count = 0;
  private lastMs = Number.NaN;

  /** Note a frame; a pause, as in a hidden tab, does not count as a frame time. */
  note(nowMs: number): void {
    const sinceMs = nowMs - this.lastMs;
    this.lastMs = nowMs;
    if (sinceMs > 0 && sinceMs < 1000) this.times[this.count++ % WINDOW] = sinceMs;
  }

  get full(): boolean {
    return this.count >= WINDOW + WARM_UP;
  }

  get p95Ms(): number {
    const kept = this.sorted();
    return kept[Math.floor(0.95 * (kept.length - 1))] ?? 0;
  }

  get hz(): number {
    const kept = this.sorted();
    const sum = kept.reduce((total, time) => total + time, 0);
    return sum ? (1000 * kept.length) / sum : 0;
  }

  reset(): void {
    this.count = 0;
    this.lastMs = Number.NaN;
  }

  private sorted(): Float64Array {
    return this.times.slice(0, Math.min(this.count, WINDOW)).sort();
  }
}

/** True if a processor draws, not a graphics card. */
export function drawsInSoftware(gl: WebGL2RenderingContext): boolean {
  return /swiftshader|llvmpipe|software|basic render/i.test(rendererName(gl));
}

export function rendererName(gl: WebGL2RenderingContext): string {
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  return String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
}

/**
 * Return the quality to begin with if none was chosen; slow cards are remembered.
 *
 * @param canvas Of no other use; "none" if it can't have WebGL.
 */
export function firstFineness(canvas: HTMLCanvasElement): Fineness | "none" {
  const gl = canvas.getContext("webgl2");
  if (!gl) return "none";
  const isSlow = drawsInSoftware(gl) || browser.read(KEPT) === rendererName(gl);
  // Browsers allow only some contexts at a time.
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return isSlow ? "low" : "high";
}

/** Remember that this machine is slow. */
export function rememberSlow(gl: WebGL2RenderingContext): void {
  browser.write(KEPT, rendererName(gl));
}

/** True if frames take too long at this quality. */
export function tooSlow(times: FrameTimes): boolean {
  return times.full && times.p95Ms > SLOW_MS;
}
