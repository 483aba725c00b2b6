import type { Absorber } from "./absorbers";
import type { Projection } from "./c_arm";
import { displayFragment, displayVertex, sumFragment, sumVertex } from "./shaders";

/** How sums are stored: in 32 or 16 bits per pixel. */
export interface SumFormat {
  internal: number;
  words: "full" | "half";
}

/** How line integrals become grey. */
export interface Tone {
  /** Line integrals that are black and white, with bright bones. */
  low: number;
  high: number;
  darkBones: boolean;
  mirrored: boolean;
}

/**
 * Returns how this context can add floating-point numbers of many surfaces: 32 bits need EXT_color_buffer_float and
 * EXT_float_blend; 16 bits one of two extensions. Undefined if it can do neither.
 */
export function sumFormat(
  gl: Pick<WebGL2RenderingContext, "getExtension" | "R32F" | "RGBA16F">,
): SumFormat | undefined {
  const full = gl.getExtension("EXT_color_buffer_float");
  if (full !== null && gl.getExtension("EXT_float_blend") !== null) return { internal: gl.R32F, words: "full" };
  const half = full !== null || gl.getExtension("EXT_color_buffer_half_float") !== null;
  return half ? { internal: gl.RGBA16F, words: "half" } : undefined;
}

/** The buffers of one surface on the graphics card, and the arrays that they hold. */
interface Buffers {
  array: WebGLVertexArrayObject;
  positions: WebGLBuffer;
  indices: WebGLBuffer;
  vertices: Float32Array | undefined;
  triangles: Uint32Array | undefined;
}

/** Sums attenuation along rays on the graphics card, by additive blending, and shows the sums. One per canvas. */
export class GpuProjection {
  private readonly summing: WebGLProgram;
  private readonly display: WebGLProgram;
  private readonly target: WebGLFramebuffer;
  private readonly empty: WebGLVertexArrayObject;
  private readonly buffers = new Map<Absorber, Buffers>();
  private readonly uniforms = new Map<string, WebGLUniformLocation | null>();

  private constructor(
    private readonly gl: WebGL2RenderingContext,
    readonly format: SumFormat,
    readonly size: number,
  ) {
    this.summing = program(gl, sumVertex, sumFragment);
    this.display = program(gl, displayVertex, displayFragment);
    this.target = gl.createFramebuffer();
    this.empty = gl.createVertexArray();
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, format.internal, size, size);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
  }

  /**
   * Returns a projection that draws into the canvas, of `size` pixels each way; undefined if the browser's graphics
   * cannot.
   */
  static open(canvas: HTMLCanvasElement, size: number): GpuProjection | undefined {
    canvas.width = canvas.height = size;
    const gl = canvas.getContext("webgl2", { antialias: false, depth: false, preserveDrawingBuffer: true });
    const format = gl === null ? undefined : sumFormat(gl);
    if (gl === null || format === undefined) return undefined;
    const opened = new GpuProjection(gl, format, size);
    return gl.checkFramebufferStatus(gl.FRAMEBUFFER) === gl.FRAMEBUFFER_COMPLETE ? opened : undefined;
  }

  /** Sums all surfaces. */
  project(absorbers: Absorber[], at: Projection): void {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
    gl.viewport(0, 0, this.size, this.size);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.useProgram(this.summing);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE);
    for (const name of ["right", "up", "toDetector", "isocentre"] as const) gl.uniform3fv(this.at(name), at[name]);
    gl.uniform1f(this.at("halfWidth"), at.halfWidth);
    gl.uniform1f(this.at("sourceDistance"), at.sourceDistance);
    for (const absorber of absorbers) this.add(absorber);
    gl.disable(gl.BLEND);
    gl.bindVertexArray(null);
  }

  private add(absorber: Absorber): void {
    const { gl } = this;
    this.load(absorber);
    const [qx, qy, qz, qw, tx, ty, tz] = absorber.pose ?? [0, 0, 0, 1, 0, 0, 0];
    gl.uniform4f(this.at("turn"), qx, qy, qz, qw);
    gl.uniform3f(this.at("shift"), tx, ty, tz);
    gl.uniform1f(this.at("weight"), absorber.weight);
    gl.drawElements(gl.TRIANGLES, absorber.triangles.length, gl.UNSIGNED_INT, 0);
  }

  /** Binds the surface, and uploads what has changed. */
  private load(absorber: Absorber): void {
    const { gl } = this;
    const known = this.buffers.get(absorber) ?? this.create(absorber);
    gl.bindVertexArray(known.array);
    if (known.vertices !== absorber.vertices) {
      gl.bindBuffer(gl.ARRAY_BUFFER, known.positions);
      gl.bufferData(gl.ARRAY_BUFFER, absorber.vertices, absorber.moving ? gl.STREAM_DRAW : gl.STATIC_DRAW);
      known.vertices = absorber.vertices;
    }
    if (known.triangles?.length !== absorber.triangles.length) {
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, absorber.triangles, gl.STATIC_DRAW);
      known.triangles = absorber.triangles;
    }
  }

  private create(absorber: Absorber): Buffers {
    const { gl } = this;
    const [array, positions, indices] = [gl.createVertexArray(), gl.createBuffer(), gl.createBuffer()];
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, positions);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, indices);
    const made = { array, positions, indices, vertices: undefined, triangles: undefined };
    this.buffers.set(absorber, made);
    return made;
  }

  /** Shows the sums in grey. */
  show({ low, high, darkBones, mirrored }: Tone): void {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.useProgram(this.display);
    gl.uniform2f(this.at("window"), low, high);
    gl.uniform1i(this.at("darkBones"), darkBones ? 1 : 0);
    gl.uniform1i(this.at("mirrored"), mirrored ? 1 : 0);
    gl.bindVertexArray(this.empty);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.bindVertexArray(null);
  }

  /** Returns the sums, row by row from the upper left. */
  read(): Float32Array<ArrayBuffer> {
    const { gl, size } = this;
    const pixels = new Float32Array(4 * size * size);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
    gl.readPixels(0, 0, size, size, gl.RGBA, gl.FLOAT, pixels);
    const sums = new Float32Array(size * size);
    for (let row = 0; row < size; row++) {
      for (let column = 0; column < size; column++)
        sums[row * size + column] = pixels[4 * ((size - 1 - row) * size + column)];
    }
    return sums;
  }

  /** Releases the graphics card's memory. */
  close(): void {
    this.gl.getExtension("WEBGL_lose_context")?.loseContext();
  }

  private at(name: string): WebGLUniformLocation | null {
    if (!this.uniforms.has(name)) {
      const of = ["window", "darkBones", "mirrored"].includes(name) ? this.display : this.summing;
      this.uniforms.set(name, this.gl.getUniformLocation(of, name));
    }
    return this.uniforms.get(name) ?? null;
  }
}

function program(gl: WebGL2RenderingContext, vertex: string, fragment: string): WebGLProgram {
  const made = gl.createProgram();
  for (const [type, source] of [
    [gl.VERTEX_SHADER, vertex],
    [gl.FRAGMENT_SHADER, fragment],
  ] as const) {
    // prettier-ignore
    const shader = gl.createShader(type)!;
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
  }
  gl.bindAttribLocation(made, 0, "position");
  gl.linkProgram(made);
  if (gl.getProgramParameter(made, gl.LINK_STATUS) === false) throw new Error(gl.getProgramInfoLog(made) ?? "");
  return made;
}
