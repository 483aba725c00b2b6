/**
 * Places a vertex in the picture and passes its position in the frame of the rays [m]. For a cone of rays w is the
 * depth, so that the position is interpolated linearly in space.
 */
export const sumVertex = `#version 300 es
precision highp float;
in vec3 position;
uniform vec4 turn;
uniform vec3 shift, right, up, toDetector, isocentre;
uniform float halfWidth, sourceDistance;
out vec3 place;
void main() {
  vec3 moved = position + 2.0 * cross(turn.xyz, cross(turn.xyz, position) + turn.w * position) + shift - isocentre;
  place = vec3(dot(moved, right), dot(moved, up), dot(moved, toDetector));
  float w = sourceDistance == 0.0 ? 1.0 : (sourceDistance + place.z) / sourceDistance;
  gl_Position = vec4(place.xy / halfWidth, 0.0, w);
}`;

/** Adds weight times the distance along the ray where it leaves the surface, and subtracts it where it enters. */
export const sumFragment = `#version 300 es
precision highp float;
in vec3 place;
uniform float weight, sourceDistance;
out vec4 sum;
void main() {
  float along = sourceDistance == 0.0 ? place.z : length(place + vec3(0.0, 0.0, sourceDistance)) - sourceDistance;
  sum = vec4((gl_FrontFacing ? weight : -weight) * along, 0.0, 0.0, 0.0);
}`;

/** One triangle over the whole canvas. */
export const displayVertex = `#version 300 es
void main() {
  gl_Position = vec4(vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0), 0.0, 1.0);
}`;

/**
 * Grey by the logarithm of the transmitted intensity exp(-sum), linear in the window: as film and digital detectors
 * show it. Where nothing absorbs it is black, or white with dark bones.
 */
export const displayFragment = `#version 300 es
precision highp float;
uniform highp sampler2D sums;
uniform vec2 window;
uniform bool darkBones, mirrored;
out vec4 color;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  if (mirrored) at.x = textureSize(sums, 0).x - 1 - at.x;
  float transmitted = exp(-texelFetch(sums, at, 0).r);
  float grey = clamp((-log(transmitted) - window.x) / (window.y - window.x), 0.0, 1.0);
  color = vec4(vec3(darkBones ? 1.0 - grey : grey), 1.0);
}`;
