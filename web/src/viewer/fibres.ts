/** GLSL: noise in one dimension with a period; returns value and slope. */
export const noise1 = `
float hash1(float n) { return fract(sin(n * 12.9898) * 43758.5453); }
vec2 noise1(float at, float period) {
  float cell = floor(at);
  float f = at - cell;
  float a = hash1(mod(cell, period));
  float b = hash1(mod(cell + 1.0, period));
  return vec2(mix(a, b, f * f * (3.0 - 2.0 * f)), (b - a) * 6.0 * f * (1.0 - f));
}`;

/**
 * GLSL: fibres from the rim to the middle, as a pattern of the angle around the vertical axis `fibreAxis` at the rest
 * position `vRest`. Changes `diffuseColor.rgb` and declares `fibreSlope`, the slope of the relief.
 */
export const fibrePattern = `
  vec2 fibreSlope = vec2(0.0);
  vec2 fromAxis = vRest.xy - fibreAxis;
  if (fibres > 0.0) {
    float turn = atan(fromAxis.y, fromAxis.x) / 6.2831853 + 0.5;
    float spread = length(fwidth(fromAxis)) / max(length(fromAxis), 1e-4) / 6.2831853;
    vec2 coarse = noise1(turn * 210.0, 210.0) * (1.0 - smoothstep(0.3, 0.9, spread * 210.0));
    vec2 fine = noise1(turn * 560.0, 560.0) * (1.0 - smoothstep(0.3, 0.9, spread * 560.0));
    float bundle = 0.65 * coarse.x + 0.35 * fine.x;
    diffuseColor.rgb *= 1.0 + 0.45 * fibres * (bundle - 0.4);
    diffuseColor.rgb = mix(diffuseColor.rgb, vec3(0.62, 0.36, 0.29), 0.22 * fibres * smoothstep(0.62, 0.95, bundle));
    fibreSlope = fibres * (0.65 * coarse.y + 0.35 * fine.y) * vec2(-fromAxis.y, fromAxis.x) / max(length(fromAxis), 1e-4);
  }`;
