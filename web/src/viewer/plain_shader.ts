import type * as THREE from "three";
import { fibrePattern, noise1 } from "./fibres";
import type { TissueUniforms } from "./tissue_shader";

/**
 * Replaces a standard material's shaders by those of plain quality: light, tone, haze and conversion to sRGB per vertex
 * instead of per pixel. Where the processor draws, a pixel of the standard material costs ten times as much.
 *
 * The lights are those of the standard material, without specular reflection; SECTION, PAINTED and the attributes
 * `occlusion` and `apart` act as in `addTissue`. With FIBRES the fibres remain a pattern of the pixels.
 */
export function usePlainShading(
  shader: Pick<THREE.WebGLProgramParametersWithUniforms, "uniforms" | "vertexShader" | "fragmentShader">,
  uniforms: TissueUniforms,
): void {
  Object.assign(shader.uniforms, uniforms);
  shader.vertexShader = vertexShader;
  shader.fragmentShader = fragmentShader;
}

// A surface shows its front or its back, each lit from its own side: the pixel chooses.
const vertexShader = `
uniform vec3 diffuse;
uniform float sheen;
uniform float scatter;
uniform vec3 section;
attribute float occlusion;
attribute float apart;
varying vec3 vFront;
varying vec3 vBack;
varying float vFacing;
#include <common>
#include <lights_pars_begin>
#include <tonemapping_pars_fragment>
#include <colorspace_pars_fragment>
#include <clipping_planes_pars_vertex>
#ifdef USE_FOG
  uniform vec3 fogColor;
  uniform float fogNear;
  uniform float fogFar;
#endif
#ifdef FIBRES
  varying vec3 vRest;
#endif
#ifdef MOVING
  attribute vec3 rest;
#endif

/** Irradiance from the room and from the lamps on a surface with a normal in the frame of the camera. */
void irradiance(vec3 normal, out vec3 room, out vec3 lamps) {
  room = ambientLightColor;
  #if NUM_HEMI_LIGHTS > 0
    #pragma unroll_loop_start
    for (int i = 0; i < NUM_HEMI_LIGHTS; i++) {
      room += getHemisphereLightIrradiance(hemisphereLights[i], normal);
    }
    #pragma unroll_loop_end
  #endif
  lamps = vec3(0.0);
  #if NUM_DIR_LIGHTS > 0
    #pragma unroll_loop_start
    for (int i = 0; i < NUM_DIR_LIGHTS; i++) {
      lamps += saturate(dot(normal, directionalLights[i].direction)) * directionalLights[i].color;
    }
    #pragma unroll_loop_end
  #endif
}

vec3 displayed(vec3 light, float distance) {
  #ifndef PAINTED
    light = ACESFilmicToneMapping(light);
  #endif
  light = sRGBTransferOETF(vec4(light, 1.0)).rgb;
  #ifdef USE_FOG
    light = mix(light, fogColor, smoothstep(fogNear, fogFar, distance));
  #endif
  return light;
}

vec3 litSide(vec3 albedo, vec3 normal, float distance) {
  #ifdef PAINTED
    return displayed(albedo * mix(0.6, 1.0, smoothstep(0.0, 0.4, vFacing)), distance);
  #else
    vec3 room, lamps;
    irradiance(normal, room, lamps);
    float open = 1.0 - 0.85 * occlusion;
    vec3 openLight = open / (1.0 - 0.75 * albedo * (1.0 - open));
    vec3 light = RECIPROCAL_PI * albedo * (room * openLight + lamps * mix(vec3(1.0), openLight, 0.55));
    float grazing = (1.0 - vFacing) * (1.0 - vFacing);
    light += sheen * grazing * mix(albedo, vec3(1.0), 0.35) * open;
    return displayed(light + scatter * albedo, distance);
  #endif
}

void main() {
  #include <beginnormal_vertex>
  #include <defaultnormal_vertex>
  #include <begin_vertex>
  #include <project_vertex>
  #include <clipping_planes_vertex>
  vec3 albedo = diffuse;
  #ifdef USE_COLOR
    albedo *= color;
  #endif
  #ifndef PAINTED
    albedo = mix(albedo, vec3(0.16, 0.14, 0.15) + 0.1 * albedo, apart);
  #endif
  vec3 normal = normalize(transformedNormal);
  vFacing = abs(dot(normal, normalize(mvPosition.xyz)));
  vFront = litSide(albedo, normal, -mvPosition.z);
  #if defined(SECTION) && !defined(PAINTED)
    vBack = displayed(section, -mvPosition.z);
  #else
    vBack = litSide(albedo, -normal, -mvPosition.z);
  #endif
  #if defined(FIBRES) && defined(MOVING)
    vRest = rest;
  #elif defined(FIBRES)
    vRest = position;
  #endif
}`;

const fragmentShader = `
uniform float opacity;
varying vec3 vFront;
varying vec3 vBack;
varying float vFacing;
#include <common>
#include <clipping_planes_pars_fragment>
#ifdef FIBRES
  uniform float fibres;
  uniform vec2 fibreAxis;
  varying vec3 vRest;
  ${noise1}
#endif
void main() {
  #include <clipping_planes_fragment>
  vec4 diffuseColor = vec4(gl_FrontFacing ? vFront : vBack, opacity);
  #if defined(FIBRES) && !defined(PAINTED)
    ${fibrePattern}
  #endif
  #ifndef OPAQUE
    float edge = mix(0.38, 2.7, (1.0 - vFacing) * (1.0 - vFacing)) * (gl_FrontFacing ? 1.0 : 0.45);
    diffuseColor.a *= mix(edge, 1.0, diffuseColor.a * diffuseColor.a);
  #endif
  gl_FragColor = diffuseColor;
}`;
