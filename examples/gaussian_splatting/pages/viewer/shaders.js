// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

// Shaders. See render/project and render/blend of the program for the same computation.

/** The real spherical harmonics up to degree 3 of a unit vector. */
const basis = `void basis(vec3 d, out float b[16]) {
  float x = d.x, y = d.y, z = d.z, xx = x * x, yy = y * y, zz = z * z;
  b[0] = 0.28209479177387814;
  b[1] = -0.4886025119029199 * y;
  b[2] = 0.4886025119029199 * z;
  b[3] = -0.4886025119029199 * x;
  b[4] = 1.0925484305920792 * x * y;
  b[5] = -1.0925484305920792 * y * z;
  b[6] = 0.31539156525252005 * (2. * zz - xx - yy);
  b[7] = -1.0925484305920792 * x * z;
  b[8] = 0.5462742152960396 * (xx - yy);
  b[9] = -0.5900435899266435 * y * (3. * xx - yy);
  b[10] = 2.890611442640554 * x * y * z;
  b[11] = -0.4570457994644658 * y * (4. * zz - xx - yy);
  b[12] = 0.3731763325901154 * z * (2. * zz - 3. * xx - 3. * yy);
  b[13] = -0.4570457994644658 * x * (4. * zz - xx - yy);
  b[14] = 1.445305721320277 * z * (xx - yy);
  b[15] = -0.5900435899266435 * x * (xx - 3. * yy);
}`;

const vertexShader = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
uniform usampler2D gaussians, harmonics;
uniform sampler2D chunks;
uniform mat3 rotation;                // from the world to the camera
uniform vec3 position;                // of the camera
uniform vec2 focal, center, size;     // in pixels
uniform vec4 bounds;                  // of x/z and y/z in the Jacobian
uniform float near, pickScale;        // pickScale > 0: draws depths in this unit
uniform int degree, coloredChunks;
uniform bool antialiased;
in uint index;
out vec2 whitened;
flat out vec4 color;                  // and log2 of the opacity

uvec4 texel(usampler2D from, uint i) {
  uint width = uint(textureSize(from, 0).x);
  return texelFetch(from, ivec2(i % width, i / width), 0);
}
vec3 bound(int k) {
  int i = int(index >> 8u) * (coloredChunks == 1 ? 6 : 4) + k, width = textureSize(chunks, 0).x;
  return texelFetch(chunks, ivec2(i % width, i / width), 0).rgb;
}
vec3 share(uint v) { return vec3(v >> 21u, v >> 11u & 1023u, v & 2047u) / vec3(2047, 1023, 2047); }
mat3 rotationOf(uint v) {
  vec3 o = (vec3(v >> 20u & 1023u, v >> 10u & 1023u, v & 1023u) / 1023. - 0.5) * 1.4142135623730951;
  float most = sqrt(max(0., 1. - dot(o, o)));
  uint which = v >> 30u;
  vec4 q = which == 0u ? vec4(most, o) : which == 1u ? vec4(o.x, most, o.yz)
         : which == 2u ? vec4(o.xy, most, o.z) : vec4(o, most);
  float w = q.x, x = q.y, y = q.z, z = q.w;
  return mat3(1. - 2. * (y * y + z * z), 2. * (x * y + w * z), 2. * (x * z - w * y),
              2. * (x * y - w * z), 1. - 2. * (x * x + z * z), 2. * (y * z + w * x),
              2. * (x * z + w * y), 2. * (y * z - w * x), 1. - 2. * (x * x + y * y));
}
${basis}
vec3 viewDependent(vec3 direction) {
  vec3 sum = vec3(0);
  if (degree == 0) return sum;
  float b[16];
  basis(direction, b);
  int terms = (degree + 1) * (degree + 1) - 1, texels = (3 * terms + 15) / 16;
  uvec4 part[3];
  for (int k = 0; k < texels; k++) part[k] = texel(harmonics, index * uint(texels) + uint(k));
  for (int k = 0; k < terms; k++)
    for (int c = 0; c < 3; c++) {
      int at = c * terms + k;
      uint v = part[at >> 4][at >> 2 & 3] >> uint(8 * (at & 3)) & 255u;
      float level = v == 0u ? 0. : v == 255u ? 1. : (float(v) + 0.5) / 256.;
      sum[c] += b[k + 1] * (level - 0.5) * 8.;
    }
  return sum;
}
void main() {
  gl_Position = vec4(0, 0, 2, 1);     // not drawn
  whitened = vec2(0);
  color = vec4(0);
  uvec4 g = texel(gaussians, index);
  vec3 mean = mix(bound(0), bound(1), share(g.x)), at = rotation * (mean - position);
  if (at.z <= near) return;
  vec2 tangent = at.xy / at.z, held = clamp(tangent, bounds.xy, bounds.zw), place = focal * tangent + center;
  mat3 axes = transpose(rotation), turn = rotationOf(g.y);
  vec3 scale = exp(mix(bound(2), bound(3), share(g.z)));
  vec3 ax = focal.x / at.z * ((axes[0] - held.x * axes[2]) * turn) * scale;
  vec3 ay = focal.y / at.z * ((axes[1] - held.y * axes[2]) * turn) * scale;
  const float twoLn2 = 1.3862943611198906, filtered = 0.3;
  vec3 area = cross(ax, ay);
  float sx = dot(ax, ax), sy = dot(ay, ay), xx = sx + filtered, xy = dot(ax, ay);
  float determinant = dot(area, area) + filtered * (xx + sy);
  float p = inversesqrt(twoLn2 * xx), q = sqrt(xx / (twoLn2 * determinant)), r = -q * xy / xx;
  float opacity = float(g.w & 255u) / 255.;
  if (antialiased) opacity *= twoLn2 * p * q * length(area);
  float cutoff = log2(255. * opacity);
  if (!(cutoff > 0.)) return;
  float reach = sqrt(cutoff);
  vec2 half_ = reach * sqrt(twoLn2 * vec2(xx, sy + filtered));
  if (any(lessThan(place + half_, vec2(0))) || any(greaterThan(place - half_, size))) return;
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2. - 1.;
  whitened = reach * corner;
  float dx = whitened.x / p, dy = (whitened.y - r * dx) / q;
  vec2 pixel = place + vec2(dx, dy);
  gl_Position = vec4(2. * pixel.x / size.x - 1., 1. - 2. * pixel.y / size.y, 0, 1);
  vec3 base = vec3(g.w >> 24u, g.w >> 16u & 255u, g.w >> 8u & 255u) / 255.;
  if (coloredChunks == 1) base = mix(bound(4), bound(5), base);
  vec3 rgb = max(vec3(0), base + viewDependent(normalize(mean - position)));
  color = vec4(pickScale > 0. ? vec3(at.z / pickScale) : rgb, log2(opacity));
}`;

const fragmentShader = `#version 300 es
precision highp float;
in vec2 whitened;
flat in vec4 color;
out vec4 pixel;
void main() {
  float alpha = min(0.99, exp2(color.a - dot(whitened, whitened)));
  if (alpha < 1. / 255.) discard;
  pixel = vec4(color.rgb * alpha, alpha);
}`;

const skyVertexShader = `#version 300 es
void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4. - 1., 0, 1); }`;

const skyFragmentShader = `#version 300 es
precision highp float;
uniform mat3 rotation;
uniform vec2 focal, center, size;
uniform vec3 sky[16];
out vec4 pixel;
${basis}
void main() {
  vec2 at = vec2(gl_FragCoord.x, size.y - gl_FragCoord.y);
  float b[16];
  basis(normalize(vec3((at - center) / focal, 1) * rotation), b);
  vec3 sum = vec3(0.5);
  for (int k = 0; k < 16; k++) sum += b[k] * sky[k];
  pixel = vec4(sum, 1);
}`;
