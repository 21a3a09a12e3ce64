// The renderer for a GPU: one vertex a voxel, drawn as a square that is large enough to close surfaces.
import { background, is_by_vertex, palette, SHADES } from "./palette.js";

/** @typedef {import("./map_store.js").MapLevel} MapLevel */
/** @typedef {import("./map_store.js").Chunk} Chunk */
/** @typedef {import("./camera.js").Camera} Camera */

const VERTEX = `#version 300 es
layout(location = 0) in uvec4 vertex; // x, y, z in the chunk; shade
uniform vec3 corner;                  // of the chunk, from what is in the middle of the screen (m)
uniform vec3 right, up, into;
uniform vec2 metres_to_clip;
uniform float edge, size, low, high, base, by_vertex;
flat out ivec2 shade;
void main() {
  vec3 p = corner + (vec3(vertex.xyz) + 0.5) * edge;
  float share = (base + p.z - low) / (high - low);
  gl_Position = vec4(dot(p, right) * metres_to_clip.x, dot(p, up) * metres_to_clip.y, dot(p, into) / 3000.0, 1.0);
  if (share < 0.0 || share > 1.0) gl_Position.z = 2.0; // not drawn
  gl_PointSize = size;
  int colour = by_vertex > 0.5 ? int(vertex.w >> 2) : min(${SHADES - 1}, int(${SHADES}.0 * share));
  shade = ivec2(colour, int(vertex.w & 1u));
}`;
const FRAGMENT = `#version 300 es
precision mediump float;
uniform sampler2D colours;
flat in ivec2 shade;
out vec4 colour;
void main() { colour = texelFetch(colours, shade, 0); }`;

/** Whether a context draws on a processor, not on a GPU. @param {WebGL2RenderingContext} gl */
function is_software(gl) {
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  const name = String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  return /swiftshader|llvmpipe|software/i.test(name);
}

export class WebglRenderer {
  /**
   * Nothing where there is no GPU.
   * @param {HTMLCanvasElement} canvas
   * @param {boolean} always also without one
   */
  static make(canvas, always) {
    // Asked of another canvas: one that has a WebGL context takes no other.
    const probe = document.createElement("canvas").getContext("webgl2");
    if (!probe || (!always && is_software(probe))) return undefined;
    const gl = canvas.getContext("webgl2", { alpha: false, antialias: false });
    return gl ? new WebglRenderer(canvas, gl) : undefined;
  }

  /**
   * @param {HTMLCanvasElement} canvas
   * @param {WebGL2RenderingContext} gl
   */
  constructor(canvas, gl) {
    this.name = "webgl";
    this.canvas = canvas;
    this.gl = gl;
    /** @type {WeakMap<Chunk, {buffer: WebGLBuffer, version: number}>} */
    this.buffers = new WeakMap();
    this.program = /** @type {WebGLProgram} */ (gl.createProgram());
    this.compile(gl.VERTEX_SHADER, VERTEX);
    this.compile(gl.FRAGMENT_SHADER, FRAGMENT);
    gl.linkProgram(this.program);
    gl.useProgram(this.program);
    gl.enable(gl.DEPTH_TEST);
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    /** @type {Map<string, WebGLUniformLocation | null>} */
    this.uniforms = new Map();
    this.set_theme("height");
  }

  /**
   * @param {number} kind
   * @param {string} source
   */
  compile(kind, source) {
    const shader = /** @type {WebGLShader} */ (this.gl.createShader(kind));
    this.gl.shaderSource(shader, source);
    this.gl.compileShader(shader);
    this.gl.attachShader(this.program, shader);
  }

  /** @param {string} name */
  uniform(name) {
    if (!this.uniforms.has(name)) this.uniforms.set(name, this.gl.getUniformLocation(this.program, name));
    return this.uniforms.get(name) ?? null;
  }

  /** @param {string} colour */
  set_theme(colour) {
    const { gl } = this;
    const back = background();
    gl.clearColor((back & 255) / 255, ((back >> 8) & 255) / 255, ((back >> 16) & 255) / 255, 1);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, SHADES, 2, 0, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(palette(colour).buffer));
  }

  /**
   * @param {number} width
   * @param {number} height
   */
  resize(width, height) {
    [this.canvas.width, this.canvas.height] = [width, height];
    this.gl.viewport(0, 0, width, height);
  }

  /**
   * @param {MapLevel} level
   * @param {Camera} camera
   * @param {import("./splat.js").Look} look
   */
  draw(level, camera, look) {
    const { gl } = this;
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniform3fv(this.uniform("right"), camera.right);
    gl.uniform3fv(this.uniform("up"), camera.up);
    gl.uniform3fv(this.uniform("into"), camera.into);
    gl.uniform2f(this.uniform("metres_to_clip"), (2 * camera.scale) / camera.width, (2 * camera.scale) / camera.height);
    const values = { edge: level.edge_m, size: Math.max(1, Math.ceil(level.edge_m * camera.scale * 1.2)), low: look.low,
      high: look.high, base: camera.target[2], by_vertex: is_by_vertex(look) ? 1 : 0 };
    for (const [name, value] of Object.entries(values)) gl.uniform1f(this.uniform(name), value);
    for (const chunk of level.chunks.values()) {
      const low_m = chunk.at[2] * level.edge_m;
      if (!chunk.vertices.length || low_m > look.high || low_m + 64 * level.edge_m < look.low) continue;
      this.bind(chunk);
      gl.uniform3fv(this.uniform("corner"), chunk.at.map((v, axis) => v * level.edge_m - camera.target[axis]));
      gl.drawArrays(gl.POINTS, 0, chunk.vertices.length);
    }
  }

  /** @param {Chunk} chunk */
  bind(chunk) {
    const { gl } = this;
    let held = this.buffers.get(chunk);
    const is_new = !held || held.version !== chunk.version;
    if (!held) this.buffers.set(chunk, (held = { buffer: /** @type {WebGLBuffer} */ (gl.createBuffer()), version: 0 }));
    gl.bindBuffer(gl.ARRAY_BUFFER, held.buffer);
    if (is_new) gl.bufferData(gl.ARRAY_BUFFER, chunk.vertices, gl.DYNAMIC_DRAW);
    held.version = chunk.version;
    gl.enableVertexAttribArray(0);
    gl.vertexAttribIPointer(0, 4, gl.UNSIGNED_BYTE, 0, 0);
  }
}
