/** Rings of light that spread from a marker in the colour of the team that took it. */

import {
  AdditiveBlending,
  type BufferGeometry,
  type Mesh,
  type MeshBasicMaterial,
  RingGeometry,
  SRGBColorSpace,
} from "three";
import type { MarkerInfo } from "../core/wire";
import { mix, type Rgb } from "./palette";

const PULSE_MS = 900;
const MOST_PULSES = 24;
const LEAST_RADIUS_M = 0.06;

interface Pulse {
  mesh: Mesh;
  sinceMs: number;
  radius: number;
}

export class Pulses {
  private readonly pulses: Pulse[] = [];

  /** @param mark Puts a flat mark on the floor, hidden until it is used. */
  constructor(private readonly mark: (geometry: BufferGeometry) => Mesh) {}

  /** Let one begin, if not too many are on already. */
  begin(marker: MarkerInfo, colour: Rgb, nowMs: number): void {
    const pulse = this.free();
    if (!pulse) return;
    const tint = mix(colour, [1, 1, 1], 0.35);
    materialOf(pulse).color.setRGB(tint[0], tint[1], tint[2], SRGBColorSpace);
    pulse.mesh.position.set(marker.x_m, marker.y_m, 0.006);
    pulse.mesh.visible = true;
    pulse.sinceMs = nowMs;
    pulse.radius = Math.max(LEAST_RADIUS_M, marker.radius_m);
  }

  /** Spread and fade. */
  draw(nowMs: number): void {
    for (const pulse of this.pulses) {
      const { mesh, sinceMs, radius } = pulse;
      const part = (nowMs - sinceMs) / PULSE_MS;
      mesh.visible = mesh.visible && part >= 0 && part < 1;
      if (!mesh.visible) continue;
      mesh.scale.setScalar(radius * (0.9 + 0.75 * (1 - (1 - part) ** 3)));
      materialOf(pulse).opacity = 0.75 * (1 - part) ** 1.5;
    }
  }

  /** Hide all that are on. */
  end(): void {
    for (const { mesh } of this.pulses) mesh.visible = false;
  }

  private free(): Pulse | undefined {
    const found = this.pulses.find(({ mesh }) => !mesh.visible);
    if (found || this.pulses.length >= MOST_PULSES) return found;
    const made = { mesh: this.mark(new RingGeometry(0.86, 1, 40)), sinceMs: 0, radius: 0 };
    materialOf(made).blending = AdditiveBlending;
    this.pulses.push(made);
    return made;
  }
}

function materialOf({ mesh }: Pulse): MeshBasicMaterial {
  return mesh.material as MeshBasicMaterial;
}
