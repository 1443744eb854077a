/** Materials: team patterns, and a floor with fine lines. */

import {
  type Color,
  type Material,
  MeshBasicMaterial,
  MeshStandardMaterial,
  type WebGLProgramParametersWithUniforms,
} from "three";

/** For each instance or corner: kind of pattern (palette.ts), and its period [m]. */
const VERTEX_HEAD = `
attribute vec2 pattern;
attribute vec3 patternColour;
varying vec3 vAt;
varying vec3 vScale;
varying vec2 vPattern;
varying vec3 vPatternColour;
`;

// In metres of the shape itself, so that the pattern rides on it.
const INSTANCED_BODY = `
vScale = vec3(length(instanceMatrix[0].xyz), length(instanceMatrix[1].xyz), length(instanceMatrix[2].xyz));
vAt = position * vScale;
vPattern = pattern;
vPatternColour = patternColour;
`;

const BAKED_HEAD = `
attribute vec3 at;
attribute vec3 half_m;
`;

const BAKED_BODY = `
vScale = half_m;
vAt = at;
vPattern = pattern;
vPatternColour = patternColour;
`;

const FRAGMENT_HEAD = `
varying vec3 vAt;
varying vec3 vScale;
varying vec2 vPattern;
varying vec3 vPatternColour;
float inside(float distance) { // smooth over one pixel
#ifdef COARSE
  return step(distance, 0.0);
#else
  return clamp(0.5 - distance / max(fwidth(distance), 1e-6), 0.0, 1.0);
#endif
}
`;

const FRAGMENT_BODY = `
if (vPattern.x > 0.5) {
  float part = 0.0;
  if (vPattern.x < 1.5) {
    part = inside(abs(fract((vAt.x + vAt.y + vAt.z) * 0.7071 / vPattern.y) - 0.5) * vPattern.y - 0.2 * vPattern.y);
  } else if (vPattern.x < 2.5) {
    vec3 cell = (fract(vAt / vPattern.y + 0.5) - 0.5) * vPattern.y;
    part = inside(length(cell) - 0.3 * vPattern.y);
  } else {
    vec3 edge = vScale - abs(vAt);
    part = inside(min(edge.x, edge.z) - vPattern.y);
  }
  diffuseColor.rgb = mix(diffuseColor.rgb, vPatternColour, part);
}
`;

/** How a kind of thing shines. */
export interface Finish {
  roughness: number;
  metalness: number;
}

/** The materials of instances, without a pattern and with one. */
export interface Pair {
  plain: Material;
  patterned: Material;
}

/** Materials for instances on a graphics card. */
export function instanced(finish: Finish): Pair {
  return {
    plain: new MeshStandardMaterial(finish),
    patterned: patch(
      new MeshStandardMaterial(finish),
      VERTEX_HEAD,
      INSTANCED_BODY,
      FRAGMENT_HEAD,
      FRAGMENT_BODY,
      "instanced pattern",
    ),
  };
}

/** A material for corners that have their light already. */
export function baked(isPatterned: boolean): Material {
  const material = new MeshBasicMaterial({ vertexColors: true });
  if (!isPatterned) return material;
  return patch(
    material,
    `${VERTEX_HEAD}${BAKED_HEAD}`,
    BAKED_BODY,
    `#define COARSE\n${FRAGMENT_HEAD}`,
    FRAGMENT_BODY,
    "baked pattern",
  );
}

/** The floor: lines each 0.1 m, stronger each 0.5 m. */
export function floor(fine: boolean, colour: Color): Material {
  if (!fine) return new MeshBasicMaterial({ color: colour });
  const material = new MeshStandardMaterial({ color: colour, roughness: 0.82, metalness: 0.05 });
  return patch(
    material,
    "varying vec2 vFloor;",
    "vFloor = (modelMatrix * vec4(position, 1.0)).xy;",
    `varying vec2 vFloor;
float grid(float step) {
  vec2 at = vFloor / step;
  vec2 wide = max(fwidth(at), 1e-6);
  vec2 near = abs(fract(at - 0.5) - 0.5) / wide;
  return (1.0 - min(min(near.x, near.y), 1.0)) * clamp(0.35 / max(wide.x, wide.y) - 0.4, 0.0, 1.0);
}`,
    "diffuseColor.rgb *= 1.0 + 0.3 * grid(0.1) + 0.45 * grid(0.5);",
    "floor",
  );
}

function patch<M extends Material>(
  material: M,
  vertexHead: string,
  vertexBody: string,
  fragmentHead: string,
  fragmentBody: string,
  name: string,
): M {
  material.onBeforeCompile = (shader: WebGLProgramParametersWithUniforms) => {
    shader.vertexShader = `${vertexHead}\n${shader.vertexShader.replace(
      "#include <begin_vertex>",
      `#include <begin_vertex>\n${vertexBody}`,
    )}`;
    shader.fragmentShader = `${fragmentHead}\n${shader.fragmentShader.replace(
      "#include <color_fragment>",
      `#include <color_fragment>\n${fragmentBody}`,
    )}`;
  };
  material.customProgramCacheKey = () => name;
  return material;
}
