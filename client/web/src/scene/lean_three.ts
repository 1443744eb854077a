import type { Plugin } from "vite";

/** Features of three that this front end does not use; leaving them out saves download. */
const UNUSED_SHADERS =
  "backgroundCube cube equirect linedashed meshlambert meshmatcap meshnormal meshphong meshtoon " +
  "points sprite shadow";

/** What no material, light or renderer of the scene turns on: names of the shaders' language. */
const UNUSED_FEATURES = (
  "ALPHA_TO_COVERAGE DECODE_VIDEO_TEXTURE DITHERING FLAT_SHADED FOG_EXP2 IOR LAMBERT PHONG " +
  "PHYSICAL USE_ALPHAHASH USE_ALPHAMAP USE_ANISOTROPY USE_ANISOTROPYMAP USE_AOMAP " +
  "USE_BATCHING USE_BATCHING_COLOR USE_BUMPMAP USE_CLEARCOAT USE_CLEARCOATMAP " +
  "USE_CLEARCOAT_NORMALMAP USE_CLEARCOAT_ROUGHNESSMAP USE_DIFFUSE_ROUGHNESS " +
  "USE_DIFFUSE_ROUGHNESSMAP USE_DISPERSION USE_DISPLACEMENTMAP USE_EMISSIVEMAP USE_ENVMAP " +
  "USE_GRADIENTMAP USE_INSTANCING_MORPH USE_IRIDESCENCE USE_IRIDESCENCEMAP " +
  "USE_IRIDESCENCE_THICKNESSMAP USE_LIGHTMAP USE_LIGHT_PROBES USE_LOGARITHMIC_DEPTH_BUFFER " +
  "USE_METALNESSMAP USE_MORPHCOLORS USE_MORPHNORMALS USE_MORPHTARGETS USE_NORMALMAP " +
  "USE_NORMALMAP_OBJECTSPACE USE_NORMALMAP_TANGENTSPACE USE_PACKED_NORMALMAP USE_POINTS_UV " +
  "USE_RETROREFLECTION USE_REVERSED_DEPTH_BUFFER USE_ROUGHNESSMAP USE_SHEEN USE_SHEEN_COLORMAP " +
  "USE_SHEEN_ROUGHNESSMAP USE_SKINNING USE_SPECULAR USE_SPECULARMAP " +
  "USE_SPECULAR_COLORMAP USE_SPECULAR_INTENSITYMAP USE_TANGENT USE_THICKNESSMAP " +
  "USE_TRANSMISSION USE_TRANSMISSIONMAP"
).split(" ");

/** What the scene has none of. */
const NONE_OF = (
  "CLIPPING_PLANES LIGHT_PROBE_GRIDS POINT_LIGHTS POINT_LIGHT_SHADOWS RECT_AREA_LIGHTS " +
  "SPOT_LIGHTS SPOT_LIGHT_COORDS SPOT_LIGHT_MAPS SPOT_LIGHT_SHADOWS SUN_LIGHTS SUN_LIGHT_SHADOWS"
).split(" ");

/** Parts of the renderer that the scene never needs, and what stands in their place. */
const UNUSED_PARTS: Record<string, string> = {
  "new WebXRManager( _this, _gl )": `{
    enabled: false, isPresenting: false, cameraAutoUpdate: false,
    addEventListener() {}, removeEventListener() {}, setAnimationLoop() {}, dispose() {},
    getEnvironmentBlendMode() {}, hasDepthSensing: () => false, getDepthSensingMesh: () => null,
  }`,
  "new WebGLEnvironments( _this )": "{ get: ( texture ) => texture, dispose() {} }",
  "new WebGLMorphtargets( _gl, capabilities, textures )": "{ update() {} }",
  "new WebGLUniformsGroups( _gl, info, capabilities, state )":
    "{ bind() {}, update() {}, dispose() {} }",
  "new WebGLOutput( _outputBufferType, canvas.width, canvas.height, antialias, depth, stencil )":
    "null",
};

/** Statements for whose sake a bundler keeps classes that nobody uses. */
const UNUSED_STATEMENTS =
  /^(?:Loader|PropertyBinding|\w*KeyframeTrack)\.(?:prototype\.)?\w+ = [^;]*;/gm;

/** Colours by name, "tomato": the scene has its colours as numbers. */
const COLOUR_NAMES = /(?<=^const _colorKeywords = \{)[^}]+/gm;

/**
 * Leave out of three what the scene (src/scene) does not use and a bundler can't see.
 *
 * Each name must be there: with another version of three the build says what is not.
 */
export function leanThree(): Plugin {
  return {
    name: "lean-three",
    apply: "build",
    enforce: "pre",
    transform(code, id) {
      if (/three[\\/]build[\\/]three\.core\.js$/.test(id))
        return { code: leanCore(code), map: null };
      if (!/three[\\/]build[\\/]three\.module\.js$/.test(id)) return null;
      return { code: leanShaders(leanRenderer(code)), map: null };
    },
  };
}

function leanCore(code: string): string {
  return [UNUSED_STATEMENTS, COLOUR_NAMES].reduce((lean, parts) => {
    if (!lean.match(parts)) throw new Error(`three has no ${parts}: see lean_three.ts`);
    return lean.replaceAll(parts, "");
  }, code);
}

function leanRenderer(code: string): string {
  return Object.entries(UNUSED_PARTS).reduce((lean, [part, by]) => without(lean, part, by), code);
}

function without(code: string, part: string, by: string): string {
  if (!code.includes(part)) throw new Error(`three has no "${part}": see lean_three.ts`);
  return code.replace(part, () => by);
}

function leanShaders(code: string): string {
  const unused = new Set<string>();
  for (const shader of UNUSED_SHADERS.split(" ")) {
    for (const kind of ["vert", "frag"]) {
      const found = new RegExp(`\\b${shader}_${kind}: ([\\w$]+)`).exec(code);
      if (!found) throw new Error(`three has no ${shader}_${kind}: see lean_three.ts`);
      unused.add(found[1]!);
    }
  }
  const seen = new Set<string>();
  const lean = code.replace(
    /^(var|const) ([\w$]+) = "((?:[^"\\]|\\.)*)";/gm,
    (_, kind, name, text) =>
      `${kind} ${name} = "${unused.has(name) ? "" : leanText(text.split("\\n"), seen).join("\\n")}";`,
  );
  const names = [...UNUSED_FEATURES, ...NONE_OF.map((what) => `NUM_${what}`)];
  const missing = names.filter((name) => !seen.has(name));
  if (missing.length) throw new Error(`three's shaders have no ${missing}: see lean_three.ts`);
  return lean;
}

interface Branch {
  /** In the words of "#if"; "": "#else". */
  condition: string;
  body: string[];
}

/** Lines of a shader without the branches that are never compiled. */
function leanText(lines: string[], seen: Set<string>): string[] {
  const open: Branch[][] = [[{ condition: "", body: [] }]];
  for (const line of lines) {
    const [, word, rest = ""] = /^(?:\\t|\s)*#(\w+)(.*)/.exec(line) ?? [];
    const branches = open.at(-1)!;
    if (word === "if" || word === "ifdef" || word === "ifndef") {
      const no = word === "ifndef" ? "!" : "";
      open.push([{ condition: word === "if" ? rest : `${no} defined(${rest} )`, body: [] }]);
    } else if (word === "elif" || word === "else") branches.push({ condition: rest, body: [] });
    else if (word === "endif")
      open
        .at(-2)!
        .at(-1)!
        .body.push(...leanBranches(open.pop()!, seen));
    else branches.at(-1)!.body.push(line);
  }
  return open[0]![0]!.body;
}

function leanBranches(branches: Branch[], seen: Set<string>): string[] {
  const lines: string[] = [];
  for (const { condition, body } of branches) {
    const is = condition ? truth(condition, seen) : true;
    if (is === false) continue;
    if (is && !lines.length) return body;
    lines.push(is ? "#else" : `#${lines.length ? "elif" : "if"} ${condition.trim()}`, ...body);
    if (is) break;
  }
  return lines.length ? [...lines, "#endif"] : [];
}

/** Whether a condition of a shader holds; undefined: it depends on the material or the machine. */
type Truth = boolean | undefined;

function truth(condition: string, seen: Set<string>): Truth {
  const words = condition.match(/defined\s*\(\s*\w+\s*\)|&&|\|\||[()!]|[^\s()!&|][^()!&|]*/g) ?? [];
  const left = words.map((word) => word.trim());
  // One term that is `wins` decides alone.
  const joined = (sign: string, wins: boolean, term: () => Truth): Truth => {
    const terms = [term()];
    while (left[0] === sign) {
      left.shift();
      terms.push(term());
    }
    if (terms.includes(wins)) return wins;
    return terms.includes(undefined) ? undefined : !wins;
  };
  const either = () => joined("||", true, both);
  const both = () => joined("&&", false, one);
  const one = (): Truth => {
    const word = left.shift() ?? "";
    if (word === "!") {
      const is = one();
      return is === undefined ? is : !is;
    }
    if (word === "(") {
      const is = either();
      left.shift();
      return is;
    }
    for (const [, name = ""] of word.matchAll(/(\w+)/g)) seen.add(name);
    const [, defined] = /^defined\s*\(\s*(\w+)/.exec(word) ?? [];
    if (defined) return UNUSED_FEATURES.includes(defined) ? false : undefined;
    const [, many, least] = /^NUM_(\w+) > 0$|< NUM_(\w+)$/.exec(word) ?? [];
    return NONE_OF.includes(many ?? least ?? "") ? false : undefined;
  };
  return either();
}
