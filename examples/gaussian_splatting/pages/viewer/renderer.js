// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/** Draws the Gaussians, and the sky behind them, with WebGL. */
class Renderer {
  constructor(gl, scene, splat) {
    Object.assign(this, { gl, scene, splat, count: 0 });
    this.textureWidth = Math.min(4096, gl.getParameter(gl.MAX_TEXTURE_SIZE));
    this.isFloat = Boolean(gl.getExtension('EXT_color_buffer_float') ||
                           gl.getExtension('EXT_color_buffer_half_float'));
    this.program = this.makeProgram(vertexShader, fragmentShader);
    if (scene.sky.length) this.sky = this.makeProgram(skyVertexShader, skyFragmentShader);
    this.makeTextures();
    this.splat = { degree: splat.degree, perChunk: splat.perChunk };  // the device has the rest
    this.vertices = gl.createVertexArray();
    gl.bindVertexArray(this.vertices);
    this.order = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, this.order);
    const index = gl.getAttribLocation(this.program.handle, 'index');
    gl.enableVertexAttribArray(index);
    gl.vertexAttribIPointer(index, 1, gl.UNSIGNED_INT, 0, 0);
    gl.vertexAttribDivisor(index, 1);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    this.framebuffer = gl.createFramebuffer();
    this.target = gl.createTexture();
    this.targetSize = [0, 0];
  }
  makeProgram(vertex, fragment) {
    const gl = this.gl, handle = gl.createProgram();
    for (const [type, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(handle, shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost())
        throw new Error(gl.getShaderInfoLog(shader));
    }
    gl.linkProgram(handle);
    if (!gl.getProgramParameter(handle, gl.LINK_STATUS) && !gl.isContextLost())
      throw new Error(gl.getProgramInfoLog(handle));
    return { handle, at: name => gl.getUniformLocation(handle, name) };
  }
  /** Makes a texture of texels in a row, which it continues in the next row. */
  makeTexture(unit, format, layout, type, values, channels) {
    const gl = this.gl, width = this.textureWidth, rows = Math.ceil(values.length / channels / width) || 1;
    if (rows > gl.getParameter(gl.MAX_TEXTURE_SIZE)) throw new Error('the scene is too large for this device');
    const padded = new values.constructor(rows * width * channels);
    padded.set(values);
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    gl.texImage2D(gl.TEXTURE_2D, 0, format, width, rows, 0, layout, type, padded);
  }
  makeTextures() {
    const gl = this.gl, { packed, chunks, count, harmonics, perGaussian } = this.splat;
    this.makeTexture(0, gl.RGBA32UI, gl.RGBA_INTEGER, gl.UNSIGNED_INT, packed, 4);
    this.makeTexture(1, gl.RGB32F, gl.RGB, gl.FLOAT, chunks, 3);
    const stride = 16 * Math.max(1, Math.ceil(perGaussian / 16));
    const aligned = new Uint8Array(perGaussian ? stride * count : stride);
    for (let i = 0; i < count && perGaussian; i++)
      aligned.set(harmonics.subarray(i * perGaussian, (i + 1) * perGaussian), i * stride);
    this.makeTexture(2, gl.RGBA32UI, gl.RGBA_INTEGER, gl.UNSIGNED_INT, new Uint32Array(aligned.buffer), 4);
    gl.activeTexture(gl.TEXTURE3);
  }
  setOrder(order) {
    this.count = order.length;
    this.gl.bindBuffer(this.gl.ARRAY_BUFFER, this.order);
    this.gl.bufferData(this.gl.ARRAY_BUFFER, order, this.gl.DYNAMIC_DRAW);
  }
  /** Binds an offscreen image of floats, in which many layers add up without rounding to 8 bits. */
  bindFloats(width, height) {
    const gl = this.gl;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.framebuffer);
    if (this.targetSize[0] === width && this.targetSize[1] === height) return;
    this.targetSize = [width, height];
    gl.bindTexture(gl.TEXTURE_2D, this.target);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA16F, width, height, 0, gl.RGBA, gl.HALF_FLOAT, null);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, this.target, 0);
  }
  setCamera(program, camera) {
    const gl = this.gl;
    gl.useProgram(program.handle);
    gl.uniformMatrix3fv(program.at('rotation'), true, camera.axes.flat());
    for (const name of ['focal', 'center', 'size']) gl.uniform2fv(program.at(name), camera[name]);
  }
  drawGaussians(camera, pickScale) {
    const { gl, program } = this, at = program.at;
    this.setCamera(program, camera);
    const margin = [0, 1].map(k => 0.15 * camera.size[k]);
    const least = [0, 1].map(k => (-margin[k] - camera.center[k]) / camera.focal[k]);
    const most = [0, 1].map(k => (camera.size[k] + margin[k] - camera.center[k]) / camera.focal[k]);
    gl.uniform3fv(at('position'), camera.position);
    gl.uniform4f(at('bounds'), ...least, ...most);
    gl.uniform1f(at('near'), this.scene.near);
    gl.uniform1f(at('pickScale'), pickScale);
    gl.uniform1i(at('degree'), this.splat.degree);
    gl.uniform1i(at('coloredChunks'), this.splat.perChunk === 18 ? 1 : 0);
    gl.uniform1i(at('antialiased'), this.scene.antialiased ? 1 : 0);
    ['gaussians', 'chunks', 'harmonics'].forEach((name, unit) => gl.uniform1i(at(name), unit));
    gl.enable(gl.BLEND);
    gl.bindVertexArray(this.vertices);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, this.count);
    gl.disable(gl.BLEND);
  }
  draw(camera) {
    const gl = this.gl, [width, height] = camera.size;
    if (this.isFloat) this.bindFloats(width, height);
    gl.viewport(0, 0, width, height);
    gl.clearColor(...this.scene.background, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    if (this.sky) {
      this.setCamera(this.sky, camera);
      gl.uniform3fv(this.sky.at('sky'), this.scene.sky);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    }
    this.drawGaussians(camera, 0);
    if (!this.isFloat) return;
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
    gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }
  /** Returns the depth of what a pixel shows, or nothing if it shows too little. */
  depthAt(camera, x, y, unit) {
    if (!this.isFloat) return undefined;
    const gl = this.gl, [width, height] = camera.size, row = height - 1 - y, found = new Float32Array(4);
    this.bindFloats(width, height);
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(x, row, 1, 1);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    this.drawGaussians(camera, unit);
    gl.disable(gl.SCISSOR_TEST);
    gl.readPixels(x, row, 1, 1, gl.RGBA, gl.FLOAT, found);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    return found[3] > 0.3 ? unit * found[0] / found[3] : undefined;
  }
}
