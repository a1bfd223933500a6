// A thin layer over WebGL2: programs from the page's shaders, buffers, images to draw into.
class Device {
  constructor(canvas) {
    const gl = canvas.getContext("webgl2", { antialias: false, alpha: false, powerPreference: "high-performance" });
    if (!gl) throw new Error("This browser lacks WebGL 2, so bodies are not shown. Energies and parameters are.");
    this.gl = gl;
    this.texts = jsonOf("shaders");
    // Images of 16-bit floats, for shadows and thickness; without them bodies are opaque and cast no shadow.
    this.floats = Boolean(gl.getExtension("EXT_color_buffer_float") || gl.getExtension("EXT_color_buffer_half_float"));
    this.samples = Math.min(4, gl.getParameter(gl.MAX_SAMPLES));
  }

  textOf(name) {
    return this.texts[name].replace(/#include "([^"]+)"\n/g, (_, included) => this.textOf(included));
  }

  // A program from two shaders, with `defines`; its uniforms are set by name.
  program(vertex, fragment, defines = []) {
    const { gl } = this, program = gl.createProgram();
    const head = "#version 300 es\nprecision highp float;\nprecision highp int;\nprecision highp sampler2D;\n" +
      defines.map((name) => `#define ${name}\n`).join("");
    for (const [kind, name] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, head + this.textOf(name));
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost())
        throw new Error(`${name}: ${gl.getShaderInfoLog(shader)}`);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost())
      throw new Error(`${vertex}, ${fragment}: ${gl.getProgramInfoLog(program)}`);
    const uniforms = new Map();
    for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); ++i) {
      const info = gl.getActiveUniform(program, i), name = info.name.replace(/\[0\]$/, "");
      uniforms.set(name, { type: info.type, at: gl.getUniformLocation(program, info.name) });
    }
    return { program, uniforms };
  }

  // Makes a program current, and sets those of the values that it has.
  use({ program, uniforms }, ...values) {
    const { gl } = this;
    gl.useProgram(program);
    for (const some of values)
      for (const [name, value] of Object.entries(some)) {
        const uniform = uniforms.get(name);
        if (!uniform) continue;
        const { type, at } = uniform;
        if (type === gl.FLOAT) gl.uniform1f(at, value);
        else if (type === gl.FLOAT_VEC2) gl.uniform2fv(at, value);
        else if (type === gl.FLOAT_VEC3) gl.uniform3fv(at, value);
        else if (type === gl.FLOAT_VEC4) gl.uniform4fv(at, value);
        else if (type === gl.FLOAT_MAT3) gl.uniformMatrix3fv(at, false, value);
        else if (type === gl.FLOAT_MAT4) gl.uniformMatrix4fv(at, false, value);
        else gl.uniform1i(at, value);
      }
  }

  // Vertices as a list of [buffer or data, location, numbers, options], with indices of triangles if there are any.
  array(attributes, indices) {
    const { gl } = this, vao = gl.createVertexArray();
    gl.bindVertexArray(vao);
    for (const [data, location, size, { stride = 0, offset = 0, divisor = 0 } = {}] of attributes) {
      gl.bindBuffer(gl.ARRAY_BUFFER, data instanceof WebGLBuffer ? data : this.buffer(data));
      gl.enableVertexAttribArray(location);
      if (data instanceof Uint32Array) gl.vertexAttribIPointer(location, size, gl.UNSIGNED_INT, stride, offset);
      else gl.vertexAttribPointer(location, size, gl.FLOAT, false, stride, offset);
      gl.vertexAttribDivisor(location, divisor);
    }
    if (indices) {
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
    }
    gl.bindVertexArray(null);
    return { vao, count: indices ? indices.length : 0 };
  }

  buffer(data) {
    const { gl } = this, buffer = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
    return buffer;
  }

  texture(format, width, height, { levels = 1, filter = this.gl.LINEAR, wrap = this.gl.CLAMP_TO_EDGE } = {}) {
    const { gl } = this, texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, levels, format, width, height);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, filter);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, levels > 1 ? gl.LINEAR_MIPMAP_LINEAR : filter);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, wrap);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, wrap);
    return texture;
  }

  // An image to draw into and to read; `depth` and `samples` of a renderbuffer, which is resolved into another image.
  image(format, width, height, { depth = false, samples = 0, levels = 1 } = {}) {
    const { gl } = this, image = { width, height, framebuffer: gl.createFramebuffer() };
    gl.bindFramebuffer(gl.FRAMEBUFFER, image.framebuffer);
    const store = (attachment, kind) => {
      const buffer = gl.createRenderbuffer();
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
      gl.renderbufferStorageMultisample(gl.RENDERBUFFER, samples, kind, width, height);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, attachment, gl.RENDERBUFFER, buffer);
      (image.buffers ??= []).push(buffer);
    };
    if (samples > 0) store(gl.COLOR_ATTACHMENT0, format);
    else {
      image.texture = this.texture(format, width, height, { levels });
      gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, image.texture, 0);
    }
    if (depth) store(gl.DEPTH_ATTACHMENT, gl.DEPTH_COMPONENT24);
    return image;
  }

  release(image) {
    const { gl } = this;
    gl.deleteFramebuffer(image.framebuffer);
    if (image.texture) gl.deleteTexture(image.texture);
    for (const buffer of image.buffers ?? []) gl.deleteRenderbuffer(buffer);
  }

  drawInto(image) {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, image.framebuffer);
    gl.viewport(0, 0, image.width, image.height);
  }

  bind(unit, texture) {
    const { gl } = this;
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, texture);
  }
}
