import type { Plugin } from "vite";

/** Features of three that this front end does not use; leaving them out saves download. */
const UNUSED_SHADERS =
  "backgroundCube cube equirect linedashed meshlambert meshmatcap meshnormal meshphong meshtoon " +
  "points sprite shadow";

/** Parts of shaders that are between `#ifdef USE_...` and `#endif` of a feature that is not used. */
const UNUSED_CHUNKS =
  "alphahash_fragment alphahash_pars_fragment alphamap_fragment alphamap_pars_fragment " +
  "aomap_fragment aomap_pars_fragment batching_pars_vertex batching_vertex bumpmap_pars_fragment " +
  "clearcoat_pars_fragment displacementmap_pars_vertex " +
  "displacementmap_vertex emissivemap_fragment emissivemap_pars_fragment envmap_fragment " +
  "envmap_common_pars_fragment envmap_pars_fragment envmap_pars_vertex " +
  "envmap_physical_pars_fragment envmap_vertex gradientmap_pars_fragment " +
  "iridescence_pars_fragment lightmap_pars_fragment lightprobes_pars_fragment " +
  "lights_lambert_fragment lights_lambert_pars_fragment lights_phong_fragment " +
  "lights_phong_pars_fragment lights_toon_fragment lights_toon_pars_fragment map_particle_fragment " +
  "map_particle_pars_fragment metalnessmap_pars_fragment morphcolor_vertex morphnormal_vertex " +
  "morphtarget_pars_vertex morphtarget_vertex normalmap_pars_fragment roughnessmap_pars_fragment " +
  "skinbase_vertex skinning_pars_vertex skinning_vertex skinnormal_vertex " +
  "specularmap_pars_fragment transmission_fragment transmission_pars_fragment";

/** Glasses for virtual reality: what the renderer asks them while there are none. */
const NO_GLASSES = `{
  enabled: false, isPresenting: false, cameraAutoUpdate: false,
  addEventListener() {}, removeEventListener() {}, setAnimationLoop() {}, dispose() {},
  getEnvironmentBlendMode() {}, hasDepthSensing: () => false, getDepthSensingMesh: () => null,
}`;

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
      if (!/three[\\/]build[\\/]three\.module\.js$/.test(id)) return null;
      let lean = code;
      const names = UNUSED_CHUNKS.split(" ");
      for (const shader of UNUSED_SHADERS.split(" ")) {
        for (const kind of ["vert", "frag"]) {
          const found = new RegExp(`\\b${shader}_${kind}: ([\\w$]+)`).exec(lean);
          if (!found) throw new Error(`three has no ${shader}_${kind}: see lean_three.ts`);
          names.push(found[1]!);
        }
      }
      for (const name of names) {
        const text = new RegExp(
          `^(var|const) ${name.replace("$", "\\$")} = "(?:[^"\\\\]|\\\\.)*";`,
          "m",
        );
        if (!text.test(lean)) throw new Error(`three has no shader ${name}: see lean_three.ts`);
        lean = lean.replace(text, (_, kind) => `${kind} ${name} = "";`);
      }
      const glasses = "new WebXRManager( _this, _gl )";
      if (!lean.includes(glasses)) throw new Error("three has no WebXRManager: see lean_three.ts");
      return { code: lean.replace(glasses, NO_GLASSES), map: null };
    },
  };
}
