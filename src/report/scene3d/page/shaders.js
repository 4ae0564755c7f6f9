// Colours are looked up, never computed from light: a patch has exactly the colour of its number.
const VERTEX = `
in vec3 position;
in float patchNumber;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
flat out int number;
void main() {
  number = int(patchNumber + 0.5);
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;
const FRAGMENT = `
precision highp float;
precision highp int;
precision highp sampler2D;
uniform sampler2D values;
uniform sampler2D colours;
uniform sampler2D map;
uniform vec2 range;
uniform bool inNature;
uniform bool picking;
uniform bool isBack;
flat in int number;
out vec4 colour;
vec4 striped(vec3 a, vec3 b) {
  return vec4(mod(gl_FragCoord.x + gl_FragCoord.y, 8.0) < 4.0 ? a : b, 1.0);
}
void main() {
  if (picking) {
    int n = number + 1;
    colour = vec4(float(n & 255), float((n >> 8) & 255), float((n >> 16) & 255), 255.0) / 255.0;
    return;
  }
  if (isBack) { colour = striped(vec3(0.30, 0.31, 0.32), vec3(0.38, 0.39, 0.40)); return; }
  ivec2 at = ivec2(number % ${WIDTH}, number / ${WIDTH});
  if (inNature) { colour = texelFetch(colours, at, 0); return; }
  float value = texelFetch(values, at, 0).r;
  if (value < -1e38) { colour = striped(vec3(0.72, 0.73, 0.74), vec3(0.82, 0.83, 0.84)); return; }
  int last = textureSize(map, 0).x - 1;
  float place = clamp((value - range.x) / (range.y - range.x), 0.0, 1.0);
  colour = texelFetch(map, ivec2(int(place * float(last) + 0.5), 0), 0);
}`;
// Outlines of what looks away are put out of sight with it.
const LINE_VERTEX = `
in vec3 position;
in float patchNumber;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform vec3 cameraPosition;
uniform highp sampler2D normals;
uniform bool backs;
void main() {
  int number = int(patchNumber + 0.5);
  vec3 normal = texelFetch(normals, ivec2(number % ${WIDTH}, number / ${WIDTH}), 0).xyz;
  bool away = dot(normal, cameraPosition - position) <= 0.0;
  gl_Position = away && !backs ? vec4(2.0, 2.0, 2.0, 1.0) : projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;
const LINE_FRAGMENT = `
precision highp float;
out vec4 colour;
void main() { colour = vec4(0.0, 0.0, 0.0, 0.30); }`;
const PLAIN_VERTEX = `
in vec3 position;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }`;
const PLAIN_FRAGMENT = `
precision highp float;
uniform vec3 ink;
out vec4 colour;
void main() { colour = vec4(ink, 1.0); }`;

function texture(array, width, height, format, type) {
  const t = new THREE.DataTexture(array, width, height, format, type);
  t.needsUpdate = true;
  return t;
}
// One number per patch.
function valueTexture(values) {
  const texels = new Float32Array(WIDTH * HEIGHT).fill(NONE);
  for (let i = 0; i < patches; i++) if (Number.isFinite(values[i])) texels[i] = values[i];
  return texture(texels, WIDTH, HEIGHT, THREE.RedFormat, THREE.FloatType);
}
// Red, green, blue per texel, opaque.
function colourTexture(rgb, width, height) {
  const texels = new Uint8Array(4 * width * height);
  for (let i = 0; 3 * i < rgb.length; i++) {
    for (let c = 0; c < 3; c++) texels[4 * i + c] = rgb[3 * i + c];
    texels[4 * i + 3] = 255;
  }
  return texture(texels, width, height, THREE.RGBAFormat, THREE.UnsignedByteType);
}
const patchColours = text => colourTexture(bytesOf(text), WIDTH, HEIGHT);
const mapColours = rgb => colourTexture(rgb, rgb.length / 3, 1);
