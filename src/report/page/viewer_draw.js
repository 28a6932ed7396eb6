// WebGL 2: the mesh or points, and lines of constant width.
const kMeshVertex = `#version 300 es
layout(location=0) in vec3 code;
layout(location=1) in vec2 packed_normal;
layout(location=2) in vec3 colour;
layout(location=3) in uint label;
uniform mat4 clip_world;
uniform vec3 low, step_m, eye, up;
uniform int shading;
uniform bool lit;
uniform float point_px;
uniform sampler2D palette;
out vec3 shade;
void main() {
  vec3 p = low + step_m * code;
  vec3 n = vec3(packed_normal, 1.0 - abs(packed_normal.x) - abs(packed_normal.y));
  if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
  n = normalize(n);
  float facing = abs(dot(n, normalize(eye - p)));
  shade = colour;
  if (shading == 1) shade = 0.5 + 0.5 * n;
  if (shading == 2) {
    float grey = 0.35 + 0.45 * dot(colour, vec3(0.3, 0.59, 0.11));
    shade = label == 0u ? vec3(grey) : texelFetch(palette, ivec2(int(label) - 1, 0), 0).rgb;
  }
  if (lit) shade *= shading == 0 ? 0.86 + 0.14 * facing : 0.6 + 0.4 * facing;
  gl_Position = clip_world * vec4(p, 1.0);
  gl_PointSize = point_px;
}`;
const kMeshFragment = `#version 300 es
precision mediump float;
in vec3 shade;
out vec4 pixel;
void main() { pixel = vec4(shade, 1.0); }`;
// A quad per segment, from instance attributes.
const kLineVertex = `#version 300 es
layout(location=0) in vec3 from;
layout(location=1) in vec3 to;
layout(location=2) in vec3 colour;
uniform mat4 clip_world;
uniform vec2 size_px;
uniform float width_px;
out vec3 shade;
void main() {
  vec4 a = clip_world * vec4(from, 1.0), b = clip_world * vec4(to, 1.0);
  const float near = 0.01;
  if (a.w < near && b.w >= near) a = mix(a, b, (near - a.w) / (b.w - a.w));
  if (b.w < near && a.w >= near) b = mix(b, a, (near - b.w) / (a.w - b.w));
  vec2 along = (b.xy / b.w - a.xy / a.w) * size_px;
  along /= max(length(along), 1e-6);
  bool first = gl_VertexID < 2;
  float side = (gl_VertexID & 1) == 0 ? -0.5 : 0.5;
  vec4 p = first ? a : b;
  vec2 move = vec2(-along.y, along.x) * side + along * (first ? -0.25 : 0.25);
  p.xy += move * width_px * 2.0 / size_px * p.w;
  p.z -= 0.0004 * p.w;  // before the surface that it lies on
  gl_Position = p;
  shade = colour;
}`;

function programOf(gl, vertex, fragment) {
  const program = gl.createProgram();
  for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  const at = {};
  for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); ++i) {
    const {name} = gl.getActiveUniform(program, i);
    at[name] = gl.getUniformLocation(program, name);
  }
  return {program, at};
}

class Drawing {
  constructor(canvas, model) {
    const gl = canvas.getContext('webgl2', {antialias: true, alpha: false, preserveDrawingBuffer: true});
    if (!gl) throw new Error('this browser has no WebGL 2');
    this.gl = gl;
    this.model = model;
    this.mesh = programOf(gl, kMeshVertex, kMeshFragment);
    this.line = programOf(gl, kLineVertex, kMeshFragment);
    this.uploadMesh();
    gl.enable(gl.DEPTH_TEST);
  }

  uploadMesh() {
    const {gl, model} = this;
    this.meshArray = gl.createVertexArray();
    gl.bindVertexArray(this.meshArray);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, model.bytes, gl.STATIC_DRAW);
    gl.vertexAttribPointer(0, 3, gl.UNSIGNED_SHORT, false, 12, 0);
    gl.vertexAttribPointer(1, 2, gl.BYTE, true, 12, 6);
    gl.vertexAttribPointer(2, 3, gl.UNSIGNED_BYTE, true, 12, 8);
    gl.vertexAttribIPointer(3, 1, gl.UNSIGNED_BYTE, 12, 11);
    for (let i = 0; i < 4; ++i) gl.enableVertexAttribArray(i);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, model.corners, gl.STATIC_DRAW);
    gl.bindVertexArray(null);
    const palette = new Uint8Array(256 * 4);
    model.palette.forEach((colour, i) => palette.set([...colour, 255], 4 * i));
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, palette);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  }

  // Segments of 9 numbers: from, to, colour. `set` of an earlier call is filled again.
  lines(segments, set = null) {
    const {gl} = this;
    if (!set) {
      set = {array: gl.createVertexArray(), buffer: gl.createBuffer(), count: 0};
      gl.bindVertexArray(set.array);
      gl.bindBuffer(gl.ARRAY_BUFFER, set.buffer);
      for (let i = 0; i < 3; ++i) {
        gl.vertexAttribPointer(i, 3, gl.FLOAT, false, 36, 12 * i);
        gl.enableVertexAttribArray(i);
        gl.vertexAttribDivisor(i, 1);
      }
      gl.bindVertexArray(null);
    }
    gl.bindBuffer(gl.ARRAY_BUFFER, set.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(segments), gl.DYNAMIC_DRAW);
    set.count = segments.length / 9;
    return set;
  }

  draw(view, background, shading, sets) {
    const {gl, model} = this;
    gl.viewport(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight);
    gl.clearColor(...background, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const {program, at} = this.mesh;
    gl.useProgram(program);
    gl.uniformMatrix4fv(at.clip_world, false, view.clip);
    gl.uniform3fv(at.low, model.low);
    gl.uniform3fv(at.step_m, model.step);
    gl.uniform3fv(at.eye, view.eye);
    gl.uniform1i(at.shading, shading);
    gl.uniform1i(at.lit, model.triangles > 0);
    gl.uniform1f(at.point_px, 2 * view.pixelRatio);
    gl.bindVertexArray(this.meshArray);
    gl.enable(gl.CULL_FACE);  // walls seen from behind do not hide a room
    if (model.triangles > 0) gl.drawElements(gl.TRIANGLES, model.corners.length, gl.UNSIGNED_INT, 0);
    else if (model.vertices > 0) gl.drawArrays(gl.POINTS, 0, model.vertices);
    gl.disable(gl.CULL_FACE);
    gl.useProgram(this.line.program);
    gl.uniformMatrix4fv(this.line.at.clip_world, false, view.clip);
    gl.uniform2f(this.line.at.size_px, gl.drawingBufferWidth, gl.drawingBufferHeight);
    for (const {set, width} of sets) {
      gl.uniform1f(this.line.at.width_px, width * view.pixelRatio);
      gl.bindVertexArray(set.array);
      if (set.count > 0) gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, set.count);
    }
    gl.bindVertexArray(null);
  }
}
