/** Marks on the floor that explain a walk: way, support polygon, centre of mass. */

import { BufferAttribute, BufferGeometry, DynamicDrawUsage, Mesh, MeshBasicMaterial } from "three";

/** What is marked; points are x, y [m, world]. */
export interface FloorMarks {
  /** Corners of the support polygon, in their order round it. */
  polygon: readonly (readonly [number, number])[];
  /** Centre of mass, in the plane of the floor. */
  centre: readonly [number, number] | null;
  /** Whether the centre is inside the polygon. */
  isStable: boolean;
  /** The way of the robot: x, y of each point. */
  way: ArrayLike<number>;
  /** How many points of the way lie behind; those ahead are fainter. */
  done: number;
}

type Tint = readonly [number, number, number, number];

const MOST_CORNERS = 6 * 400;
const MOST_STEPS = 240;
const EDGE_M = 0.0016;
const WAY_M = 0.0014;
const CENTRE_M = 0.006;
const ROUND = 16;
const HEIGHT_M = 0.0035;
const STABLE: Tint = [0.3, 0.85, 0.6, 0.26];
const STABLE_EDGE: Tint = [0.44, 0.94, 0.7, 0.95];
const TIPPING: Tint = [1, 0.5, 0.4, 0.3];
const TIPPING_EDGE: Tint = [1, 0.58, 0.5, 0.95];
const WAY: Tint = [0.56, 0.72, 1, 0.85];
const AHEAD: Tint = [0.56, 0.72, 1, 0.28];
const CENTRE: Tint = [1, 1, 1, 1];

/** Draws the marks as one mesh, which is written anew for each picture. */
export class FloorLayer {
  readonly mesh: Mesh<BufferGeometry, MeshBasicMaterial>;
  private readonly position = new BufferAttribute(new Float32Array(3 * MOST_CORNERS), 3);
  private readonly colour = new BufferAttribute(new Float32Array(4 * MOST_CORNERS), 4);
  private corners = 0;

  constructor() {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", this.position.setUsage(DynamicDrawUsage));
    geometry.setAttribute("color", this.colour.setUsage(DynamicDrawUsage));
    const material = new MeshBasicMaterial({
      vertexColors: true,
      transparent: true,
      depthWrite: false,
    });
    this.mesh = new Mesh(geometry, material);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 5;
    this.mesh.visible = false;
  }

  /** Show marks; null hides them. */
  draw(marks: FloorMarks | null): void {
    this.corners = 0;
    if (marks) {
      this.way(marks.way, marks.done);
      this.polygon(marks);
      if (marks.centre) this.dot(marks.centre);
    }
    this.mesh.visible = this.corners > 0;
    this.mesh.geometry.setDrawRange(0, this.corners);
    for (const attribute of [this.position, this.colour]) {
      attribute.clearUpdateRanges();
      attribute.addUpdateRange(0, this.corners * attribute.itemSize);
      attribute.needsUpdate = true;
    }
  }

  dispose(): void {
    this.mesh.removeFromParent();
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }

  private way(points: ArrayLike<number>, done: number): void {
    const count = points.length >> 1;
    const step = Math.max(1, Math.ceil(count / MOST_STEPS));
    for (let from = 0; from + step < count; from += step) {
      const to = from + step;
      const tint = from < done ? WAY : AHEAD;
      const at = (index: number) => [points[2 * index]!, points[2 * index + 1]!] as const;
      this.line(at(from), at(to), WAY_M, tint);
    }
  }

  private polygon({ polygon, isStable }: FloorMarks): void {
    const tint = isStable ? STABLE : TIPPING;
    const edge = isStable ? STABLE_EDGE : TIPPING_EDGE;
    const [first] = polygon;
    for (let at = 1; first && at + 1 < polygon.length; at++) {
      this.corner(first, tint);
      this.corner(polygon[at]!, tint);
      this.corner(polygon[at + 1]!, tint);
    }
    polygon.forEach((corner, at) => {
      this.line(corner, polygon[(at + 1) % polygon.length]!, EDGE_M, edge);
    });
  }

  private dot([x, y]: readonly [number, number]): void {
    for (let part = 0; part < ROUND; part++) {
      const [one, other] = [part, part + 1].map((at) => (at / ROUND) * 2 * Math.PI);
      this.corner([x, y], CENTRE);
      this.corner([x + CENTRE_M * Math.cos(one!), y + CENTRE_M * Math.sin(one!)], CENTRE);
      this.corner([x + CENTRE_M * Math.cos(other!), y + CENTRE_M * Math.sin(other!)], CENTRE);
    }
  }

  private line(
    [ax, ay]: readonly [number, number],
    [bx, by]: readonly [number, number],
    half: number,
    tint: Tint,
  ): void {
    const length = Math.hypot(bx - ax, by - ay);
    if (!length) return;
    const x = (-(by - ay) / length) * half;
    const y = ((bx - ax) / length) * half;
    const quad = [
      [ax + x, ay + y],
      [ax - x, ay - y],
      [bx - x, by - y],
      [ax + x, ay + y],
      [bx - x, by - y],
      [bx + x, by + y],
    ] as const;
    for (const corner of quad) this.corner(corner, tint);
  }

  private corner([x, y]: readonly [number, number], tint: Tint): void {
    if (this.corners >= MOST_CORNERS) return;
    this.position.setXYZ(this.corners, x, y, HEIGHT_M);
    this.colour.setXYZW(this.corners, ...tint);
    this.corners++;
  }
}
