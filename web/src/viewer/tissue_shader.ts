import type * as THREE from "three";
import { fibrePattern, noise1 } from "./fibres";

type Shader = THREE.WebGLProgramParametersWithUniforms;

/** What the shader of one surface knows beside the material. */
export interface TissueUniforms {
  sheen: { value: number };
  fibres: { value: number };
  /** Where the vertical axis is that the fibres run around, x y [m]. */
  fibreAxis: { value: THREE.Vector2 };
  spots: { value: number };
  spotsPerMetre: { value: number };
  scatter: { value: number };
  /** Colour of a cut, with SECTION. */
  section: { value: THREE.Color };
}

/**
 * Adds to a standard material: ambient occlusion per vertex (attribute `occlusion`), grey for vertices that are not of
 * the chosen region (attribute `apart`), fibres and spots that are fixed to the rest position (attribute `rest`), a
 * sheen at grazing angles, and translucency that is denser at the silhouette.
 *
 * With SECTION the inner side of a surface is drawn as a flat cut: through a clipped closed body one sees nothing else.
 * With PAINTED the surface has exactly its vertex colours, as a scale shows them, and is darker only where it turns
 * away.
 */
export function addTissue(shader: Shader, uniforms: TissueUniforms): void {
  Object.assign(shader.uniforms, uniforms);
  shader.vertexShader = inserted(shader.vertexShader, [
    ["#include <common>", vertexHead],
    ["#include <begin_vertex>", vertexBody],
  ]);
  shader.fragmentShader = inserted(shader.fragmentShader, [
    ["#include <common>", fragmentHead],
    ["#include <color_fragment>", pattern],
    ["#include <normal_fragment_maps>", relief],
    ["#include <aomap_fragment>", occlusion],
  ]).replace("#include <opaque_fragment>", `${finish}\n#include <opaque_fragment>`);
}

function inserted(source: string, parts: [after: string, text: string][]): string {
  return parts.reduce((text, [after, part]) => text.replace(after, `${after}\n${part}`), source);
}

const vertexHead = `
attribute float occlusion;
attribute float apart;
varying float vOcclusion;
varying float vApart;
varying vec3 vRest;
#ifdef MOVING
  attribute vec3 rest;
#endif`;

const vertexBody = `
vOcclusion = occlusion;
vApart = apart;
#ifdef MOVING
  vRest = rest;
#else
  vRest = position;
#endif`;

// Noise in three dimensions.
const fragmentHead = `
uniform float sheen;
uniform float fibres;
uniform vec2 fibreAxis;
uniform float spots;
uniform float spotsPerMetre;
uniform float scatter;
uniform vec3 section;
varying float vOcclusion;
varying float vApart;
varying vec3 vRest;
${noise1}
float hash3(vec3 p) {
  p = fract(p * 0.3183099 + 0.1);
  p *= 17.0;
  return fract(p.x * p.y * p.z * (p.x + p.y + p.z));
}
float noise3(vec3 at) {
  vec3 cell = floor(at);
  vec3 f = at - cell;
  f = f * f * (3.0 - 2.0 * f);
  vec2 o = vec2(0.0, 1.0);
  return mix(mix(mix(hash3(cell + o.xxx), hash3(cell + o.yxx), f.x), mix(hash3(cell + o.xyx), hash3(cell + o.yyx), f.x), f.y),
             mix(mix(hash3(cell + o.xxy), hash3(cell + o.yxy), f.x), mix(hash3(cell + o.xyy), hash3(cell + o.yyy), f.x), f.y), f.z);
}`;

const pattern = `
#ifndef PAINTED
  ${fibrePattern}
  diffuseColor.rgb = mix(diffuseColor.rgb, vec3(0.16, 0.14, 0.15) + 0.1 * diffuseColor.rgb, vApart);
  if (spots > 0.0) diffuseColor.rgb *= 1.0 + spots * (2.0 * noise3(vRest * spotsPerMetre) - 1.0);
#endif`;

const relief = `
#ifndef PAINTED
  normal = normalize(normal - 0.16 * (viewMatrix * vec4(fibreSlope, 0.0, 0.0)).xyz);
#endif`;

// Light between bright surfaces brightens corners (Jimenez et al. 2016, "Practical real-time strategies for accurate
// indirect occlusion"), here with one term.
const occlusion = `
#ifndef PAINTED
  float open = 1.0 - 0.85 * vOcclusion;
  vec3 openLight = open / (1.0 - 0.75 * diffuseColor.rgb * (1.0 - open));
  reflectedLight.indirectDiffuse *= openLight;
  reflectedLight.indirectSpecular *= open * open;
  reflectedLight.directDiffuse *= mix(vec3(1.0), openLight, 0.55);
  reflectedLight.directSpecular *= open;
#endif`;

const finish = `
float facing = saturate(abs(dot(normal, normalize(vViewPosition))));
#ifdef PAINTED
  outgoingLight = diffuseColor.rgb * mix(0.6, 1.0, smoothstep(0.0, 0.4, facing));
#else
  float grazing = (1.0 - facing) * (1.0 - facing);
  outgoingLight += sheen * grazing * mix(diffuseColor.rgb, vec3(1.0), 0.35) * (1.0 - 0.85 * vOcclusion);
  outgoingLight += scatter * diffuseColor.rgb;
  #ifdef SECTION
    if (!gl_FrontFacing) outgoingLight = section;
  #endif
#endif
#ifndef OPAQUE
  float edge = mix(0.38, 2.7, (1.0 - facing) * (1.0 - facing)) * (gl_FrontFacing ? 1.0 : 0.45);
  diffuseColor.a *= mix(edge, 1.0, diffuseColor.a * diffuseColor.a);
#endif`;
