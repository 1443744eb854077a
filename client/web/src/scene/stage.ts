/** The three-dimensional picture: builds a scene's shapes once, then only moves them. */

import {
  type BufferGeometry,
  Color,
  DirectionalLight,
  Float32BufferAttribute,
  HemisphereLight,
  LinearSRGBColorSpace,
  type Material,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  NeutralToneMapping,
  NoToneMapping,
  PCFShadowMap,
  PerspectiveCamera,
  PlaneGeometry,
  Quaternion,
  RingGeometry,
  SRGBColorSpace,
  Vector3,
  WebGLRenderer,
  Scene as World,
} from "three";
import type { SceneGeom } from "../core/wire";
import { BakedLayer } from "./baked";
import { FOV_RAD, type ViewAxes } from "./cameras";
import { InstancedLayer } from "./instanced";
import { type Layer, reserveAll } from "./layer";
import { MarkerMotion } from "./markers";
import { FloorLayer, type FloorMarks } from "./marks";
import { type Finish, floor } from "./materials";
import type { Model } from "./model";
import { afflicted, evening, ghostly, LIT, mix, type Rgb, rgb } from "./palette";
import { EYE, type Piece, piecesOf } from "./pieces";
import { Pulses } from "./pulses";
import type { Fineness } from "./quality";

/** The thing under the pointer: a ring is drawn round it. */
export interface Ring {
  x: number;
  y: number;
  radius: number;
}

/** What is drawn besides the match. */
export interface Extras {
  /** Bodies of robots that glow, and how strongly, from 0 to 1. */
  lit: ReadonlyMap<number, number>;
  /** The same robots as they were in another trial. */
  ghost: Model | null;
  marks: FloorMarks | null;
}

const NO_EXTRAS: Extras = { lit: new Map(), ghost: null, marks: null };
const GHOST = 0.34;
const GROUND: Rgb = [0.055, 0.072, 0.1];
const DARK = [0.066, 0.09, 0.13] as const;
const SHADOW_MAP = 2048;

export class Stage {
  readonly renderer: WebGLRenderer;
  private readonly world = new World();
  private readonly camera = new PerspectiveCamera((FOV_RAD * 180) / Math.PI, 1, 0.05, 40);
  private readonly fine: boolean;
  private readonly space: typeof SRGBColorSpace | typeof LinearSRGBColorSpace;
  private readonly extras: { geometry: BufferGeometry; material: Material }[] = [];
  private model: Model | null = null;
  private motion: MarkerMotion | null = null;
  private layers: { still: Layer; markers: Layer; robots: Layer } | null = null;
  private ghosts: Layer | null = null;
  private floorLayer: FloorLayer | null = null;
  private markerPieces: Piece[] = [];
  private robotPieces: Piece[] = [];
  private markersDrawn = false;
  private readonly sun: DirectionalLight;
  private readonly ring: Mesh;
  private readonly pulses: Pulses;
  private readonly blobs: Mesh[] = [];
  private readonly ghostColours = new Map<Rgb, Rgb>();
  private readonly litColours = new Map<number, Map<Rgb, Rgb>>();
  private readonly matrix = new Matrix4();
  private readonly pose = new Matrix4();

  /**
   * @param canvas A new canvas.
   * @param context Of that canvas.
   * @param fineness What it is drawn with; another one needs another stage.
   */
  constructor(
    readonly canvas: HTMLCanvasElement,
    context: WebGL2RenderingContext,
    readonly fineness: Fineness,
    transparent: boolean,
  ) {
    this.fine = fineness === "high";
    this.renderer = new WebGLRenderer({
      canvas,
      context,
      alpha: true,
      premultipliedAlpha: true,
    });
    // Going from light to screen takes three powers a pixel: too much without a graphics card.
    this.space = this.fine ? SRGBColorSpace : LinearSRGBColorSpace;
    this.renderer.outputColorSpace = this.space;
    if (transparent || this.fine) this.renderer.setClearColor(0x000000, 0);
    else this.renderer.setClearColor(new Color().setRGB(...DARK, this.space), 1);
    this.renderer.toneMapping = this.fine ? NeutralToneMapping : NoToneMapping;
    this.renderer.toneMappingExposure = 1.12;
    this.renderer.shadowMap.enabled = this.fine;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.sun = this.light();
    this.ring = this.mark(new RingGeometry(0.92, 1, this.fine ? 64 : 32), [1, 1, 1], 0.9);
    this.pulses = new Pulses((geometry) => this.mark(geometry, [1, 1, 1], 1));
    if (!transparent && this.fine) this.ground();
  }

  private light(): DirectionalLight {
    const sun = new DirectionalLight(0xfff6ea, 2.5);
    if (!this.fine) return sun;
    this.world.add(sun, sun.target, new HemisphereLight(0xe6eeff, 0x6a7688, 1.9));
    // From behind, for edges; from where the cameras are, for faces.
    const back = new DirectionalLight(0x9cc2ff, 0.9);
    back.position.set(1.6, 2.4, 1.2);
    const front = new DirectionalLight(0xffffff, 0.85);
    front.position.set(0.5, -3, 0.9);
    this.world.add(back, front);
    sun.castShadow = true;
    sun.shadow.mapSize.set(SHADOW_MAP, SHADOW_MAP);
    sun.shadow.bias = -0.0004;
    sun.shadow.normalBias = 0.004;
    sun.shadow.radius = 3.5;
    return sun;
  }

  /** The hall's ground round the arena: a pool of light that ends in the dark. */
  private ground(): void {
    const geometry = new RingGeometry(0.01, 6, 48, 12);
    const at = geometry.getAttribute("position");
    const colours: number[] = [];
    for (let vertex = 0; vertex < at.count; vertex++) {
      const far = Math.hypot(at.getX(vertex), at.getY(vertex)) / 6;
      const glow = Math.max(0, 1 - far) ** 2;
      colours.push(...GROUND.map((part) => part * 0.55 * (0.6 + glow)), glow);
    }
    geometry.setAttribute("color", new Float32BufferAttribute(colours, 4));
    const material = new MeshBasicMaterial({ vertexColors: true, transparent: true });
    const mesh = new Mesh(geometry, material);
    mesh.position.z = -0.012;
    mesh.renderOrder = 4;
    this.world.add(mesh);
    this.extras.push({ geometry, material });
  }

  /** A flat mark on the floor, hidden until it is used. */
  private mark(geometry: BufferGeometry, colour: Rgb, opacity: number): Mesh {
    const material = new MeshBasicMaterial({
      color: new Color().setRGB(...(colour as [number, number, number]), this.space),
      transparent: true,
      opacity,
      depthWrite: false,
    });
    const mesh = new Mesh(geometry, material);
    mesh.visible = false;
    this.world.add(mesh);
    this.extras.push({ geometry, material });
    return mesh;
  }

  /** Build a scene. */
  setModel(model: Model): void {
    this.clearModel();
    this.model = model;
    const { scene, sheet } = model;
    this.motion = new MarkerMotion(scene, sheet.markers);
    // The top layer is drawn first, so the shapes that it covers need not be drawn.
    this.layers = {
      still: this.layer({ roughness: 0.75, metalness: 0.05 }, 2),
      markers: this.layer({ roughness: 0.42, metalness: 0.08 }, 1),
      robots: this.layer({ roughness: 0.36, metalness: 0.18 }, 0),
    };
    for (const geom of scene.geoms) if (geom.type === "plane") this.plane(geom);
    const { still, markers: markerPieces, robots: robotPieces } = piecesOf(model, this.motion);
    this.markerPieces = markerPieces;
    this.robotPieces = robotPieces;
    reserveAll(this.layers.still, still);
    reserveAll(this.layers.markers, markerPieces);
    reserveAll(this.layers.robots, robotPieces);
    for (const piece of still) this.put(this.layers.still, piece, this.poseOf(piece.body));
    this.layers.still.done();
    for (const seat of sheet.seats.keys()) this.blob(seat);
    this.aimSun(model);
    this.markersDrawn = false;
  }

  private layer(finish: Finish, order: number, opacity = 1): Layer {
    return this.fine
      ? new InstancedLayer(this.world, finish, order, opacity)
      : new BakedLayer(this.world, order, opacity);
  }

  private plane(geom: SceneGeom): void {
    const [x, y] = geom.size;
    const geometry = new PlaneGeometry(2 * (x || 10), 2 * (y || 10));
    const own = evening(geom.rgba.slice(0, 3) as unknown as Rgb);
    const colour = new Color().setRGB(own[0], own[1], own[2], this.space);
    const material = floor(this.fine, colour);
    const mesh = new Mesh(geometry, material);
    mesh.position.set(...geom.pos);
    mesh.quaternion.set(geom.quat[1], geom.quat[2], geom.quat[3], geom.quat[0]);
    mesh.receiveShadow = this.fine;
    mesh.name = "floor";
    mesh.renderOrder = 3;
    this.world.add(mesh);
  }

  /** A soft dark spot in place of real shadows, so that robots do not seem to float. */
  private blob(seat: number): void {
    if (this.fine) return;
    const geometry = new RingGeometry(0.001, 1, 16, 2);
    const at = geometry.getAttribute("position");
    const colours: number[] = [];
    for (let vertex = 0; vertex < at.count; vertex++) {
      const far = Math.hypot(at.getX(vertex), at.getY(vertex));
      colours.push(0, 0, 0, 0.5 * Math.max(0, 1 - far) ** 0.8);
    }
    geometry.setAttribute("color", new Float32BufferAttribute(colours, 4));
    const material = new MeshBasicMaterial({
      vertexColors: true,
      transparent: true,
      depthWrite: false,
    });
    const mesh = new Mesh(geometry, material);
    mesh.scale.setScalar(0.2);
    mesh.visible = false;
    mesh.renderOrder = 1;
    this.blobs[seat] = mesh;
    this.world.add(mesh);
  }

  private aimSun({ field }: Model): void {
    const reach = Math.hypot(field.halfX, field.halfY) + 0.15;
    const { camera } = this.sun.shadow;
    Object.assign(camera, { left: -reach, right: reach, top: reach, bottom: -reach });
    camera.near = 0.5;
    camera.far = 7;
    camera.updateProjectionMatrix();
    this.sun.position.set(field.x - 1.4, field.y - 1.1, 3);
    this.sun.target.position.set(field.x, field.y, 0);
  }

  /** True while markers move to another state. */
  get moving(): boolean {
    return this.motion?.moving ?? false;
  }

  /** Set the drawing size. */
  resize(width: number, height: number, ratio: number): void {
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
  }

  /**
   * Follow the model's markers.
   *
   * @param animate True: changed markers move; false: they change at once.
   * @returns Markers that changed.
   */
  follow(nowMs: number, animate: boolean): number[] {
    const { model, motion } = this;
    if (!model || !motion) return [];
    const changed = motion.follow(model.states, nowMs, animate);
    if (motion.stale) this.markersDrawn = false;
    if (animate) {
      for (const marker of changed) {
        const seat = model.sheet.seats[(model.states[marker] ?? 0) - 1];
        if (seat) this.pulses.begin(model.sheet.markers[marker]!, rgb(seat.colour), nowMs);
      }
    }
    this.pulses.draw(nowMs);
    return changed;
  }

  /** Forget the rings of light: what is shown next is another moment. */
  cut(): void {
    this.pulses.end();
  }

  /** Draw the model as it is now; `follow` comes before. */
  draw(view: ViewAxes, nowMs: number, ring: Ring | null, extras: Extras = NO_EXTRAS): void {
    const { model, layers } = this;
    if (model && layers) {
      if (!this.markersDrawn) this.drawMarkers(nowMs);
      this.drawRobots(layers.robots, model, extras.lit);
      this.drawGhost(extras.ghost);
      this.drawMarks(extras.marks);
    }
    this.ring.visible = ring !== null;
    if (ring) {
      this.ring.position.set(ring.x, ring.y, 0.005);
      this.ring.scale.setScalar(ring.radius);
    }
    const { right, up, forward } = view;
    this.camera.position.set(...view.eye);
    this.matrix.makeBasis(axisX.set(...right), axisY.set(...up), axisZ.set(...forward).negate());
    this.camera.quaternion.setFromRotationMatrix(this.matrix);
    this.renderer.render(this.world, this.camera);
  }

  private drawMarkers(nowMs: number): void {
    const { markers } = this.layers!;
    const motion = this.motion!;
    markers.clear();
    for (const piece of this.markerPieces) {
      const { state, matrix } = motion.posture(piece.marker, nowMs);
      if (piece.state !== state && piece.state >= 0) continue;
      if (matrix && piece.stays) continue;
      this.put(markers, piece, matrix ?? identity);
    }
    markers.done();
    this.markersDrawn = true;
  }

  private drawGhost(ghost: Model | null): void {
    if (!ghost && !this.ghosts) return;
    if (!this.ghosts) {
      this.ghosts = this.layer({ roughness: 0.6, metalness: 0 }, 6, GHOST);
      const plain = this.robotPieces.map((piece) => ({ ...piece, pattern: 0 }));
      reserveAll(this.ghosts, plain);
    }
    this.ghosts.clear();
    if (ghost?.robots.length) {
      for (const piece of this.robotPieces) {
        this.matrix.multiplyMatrices(this.poseOf(piece.body, ghost), piece.local);
        const colour = this.ghostColour(piece.colour);
        this.ghosts.add(piece.shape, this.matrix, { colour, pattern: 0, period_m: 1 });
      }
    }
    this.ghosts.done();
  }

  // The same object for the same colour: then it is not sent to the graphics card again.

  private ghostColour(colour: Rgb): Rgb {
    const made = this.ghostColours.get(colour) ?? ghostly(colour);
    this.ghostColours.set(colour, made);
    return made;
  }

  private litColour(colour: Rgb, strength: number): Rgb {
    if (!strength) return colour;
    const ofStrength = this.litColours.get(strength) ?? new Map<Rgb, Rgb>();
    this.litColours.set(strength, ofStrength);
    const made = ofStrength.get(colour) ?? mix(colour, LIT, strength);
    ofStrength.set(colour, made);
    return made;
  }

  private drawMarks(marks: FloorMarks | null): void {
    if (!marks && !this.floorLayer) return;
    if (!this.floorLayer) {
      this.floorLayer = new FloorLayer();
      this.world.add(this.floorLayer.mesh);
    }
    this.floorLayer.draw(marks);
  }

  private drawRobots(layer: Layer, model: Model, lit: ReadonlyMap<number, number>): void {
    layer.clear();
    if (model.robots.length) {
      for (const piece of this.robotPieces) {
        const flags = model.robots[model.fk.seats[piece.body]!]?.flags ?? 0;
        const own = this.litColour(piece.colour, lit.get(piece.body) ?? 0);
        const colour = piece.colour === EYE ? EYE : afflicted(own, flags);
        this.put(layer, piece, this.poseOf(piece.body), colour);
      }
    }
    layer.done();
    this.blobs.forEach((blob, seat) => {
      const robot = model.robots[seat];
      blob.visible = robot !== undefined;
      if (robot) blob.position.set(robot.x, robot.y, 0.0042);
    });
  }

  private put(layer: Layer, piece: Piece, pose: Matrix4, colour = piece.colour): void {
    this.matrix.multiplyMatrices(pose, piece.local);
    layer.add(piece.shape, this.matrix, colour === piece.colour ? piece : { ...piece, colour });
  }

  private poseOf(body: number, model = this.model!): Matrix4 {
    const { pos, quat } = model.fk;
    const q = 4 * body;
    turn.set(quat[q + 1]!, quat[q + 2]!, quat[q + 3]!, quat[q]!);
    place.set(pos[3 * body]!, pos[3 * body + 1]!, pos[3 * body + 2]!);
    return this.pose.compose(place, turn, ones);
  }

  private clearModel(): void {
    if (this.layers) for (const layer of Object.values(this.layers)) layer.dispose();
    this.layers = null;
    this.ghosts?.dispose();
    this.ghosts = null;
    this.ghostColours.clear();
    this.litColours.clear();
    this.markerPieces = [];
    this.robotPieces = [];
    for (const mesh of [...this.world.children, ...this.blobs]) {
      if (!(mesh instanceof Mesh) || (mesh.name !== "floor" && !this.blobs.includes(mesh)))
        continue;
      mesh.removeFromParent();
      mesh.geometry.dispose();
      (mesh.material as Material).dispose();
    }
    this.blobs.length = 0;
    this.pulses.end();
  }

  dispose(): void {
    this.clearModel();
    this.floorLayer?.dispose();
    for (const { geometry, material } of this.extras) {
      geometry.dispose();
      material.dispose();
    }
    this.renderer.dispose();
  }
}

const identity = new Matrix4();
const ones = new Vector3(1, 1, 1);
const place = new Vector3();
const turn = new Quaternion();
const axisX = new Vector3();
const axisY = new Vector3();
const axisZ = new Vector3();
