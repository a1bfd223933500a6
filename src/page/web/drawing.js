// Images of a run, pass by pass as docs/images.md describes ours.
const units = { particles: 0, scale: 1, tiles: 2, sun_map: 3, sky_map: 4, thickness_map: 5, behind: 6, hole: 7, image: 8 };
const tileSize = 512;

class Painter {
  constructor(device, facts) {
    const { gl } = device, { view } = facts;
    Object.assign(this, { device, view, targets: null });
    const of = (...words) => device.program(...words);
    this.programs = {
      sky: of("screen.vert", "sky.frag"), present: of("screen.vert", "present.frag"), tiles: of("screen.vert", "tiles.frag"),
      ground: of("ground.vert", "ground.frag"), holed: of("ground.vert", "ground.frag", ["HOLED"]), grid: of("ground.vert", "grid.frag"),
      solid: of("mesh.vert", "solid.frag"), rods: of("mesh.vert", "rods.frag"), glass: of("mesh.vert", "glass.frag"),
      jelly: of("skin.vert", "jelly.frag"), sheet: of("skin.vert", "sheet.frag"), thickness: of("skin.vert", "thickness.frag"),
      lightSkin: of("skin.vert", "light.frag", ["LIGHT"]), lightRods: of("mesh.vert", "light.frag", ["LIGHT"]), lightBalls: of("ball.vert", "light_ball.frag", ["LIGHT"]),
      balls: of("ball.vert", "ball.frag"), particles: of("ball.vert", "ball.frag", ["PARTICLES"]),
      springs: of("spring.vert", "spring.frag"),
    };
    this.scales = { signed: this.scale(view.signedScale), other: this.scale(view.scale) };
    const levels = Math.log2(tileSize) + 1;
    const tiles = device.image(gl.SRGB8_ALPHA8, tileSize, tileSize, { levels });
    device.drawInto(tiles);
    device.use(this.programs.tiles);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    device.bind(units.tiles, tiles.texture);
    gl.generateMipmap(gl.TEXTURE_2D);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.REPEAT);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.REPEAT);
    this.tiles = tiles.texture;
  }

  scale(base64) {
    const { gl } = this.device, bytes = bytesOf(base64), texture = this.device.texture(gl.SRGB8, bytes.length / 3, 1);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, bytes.length / 3, 1, gl.RGB, gl.UNSIGNED_BYTE, bytes);
    return texture;
  }

  resize(width, height) {
    const { device, targets } = this, { gl } = device;
    if (targets && targets.width === width && targets.height === height) return;
    if (targets) for (const image of [targets.samples, targets.behind, targets.thickness]) device.release(image);
    const half = [Math.ceil(width / 2), Math.ceil(height / 2)];
    this.targets = { width, height,
      samples: device.image(gl.SRGB8_ALPHA8, width, height, { samples: device.samples, depth: true }),
      behind: device.image(gl.SRGB8_ALPHA8, width, height),
      thickness: device.image(device.floats ? gl.R16F : gl.RGBA8, ...half) };
  }

  // Draws a run onto a part of the canvas [pixels from left and bottom].
  draw(bodies, camera, look, { left, bottom, width, height }) {
    const { device, programs } = this, { gl } = device;
    this.resize(width, height);
    this.look = look;
    this.bodies = bodies;
    const tint = look.color === "material" ? look.tint ?? bodies.facts.bodies[0]?.color ?? this.view.neutral : this.view.neutral;
    const solid = look.solid && bodies.facts.bodies.some((body) => body.style === "flesh");
    const balls = bodies.facts.terrain.filter((t) => t.radius && look.terrain).slice(0, 4)
      .flatMap((t) => [...plus(t.place, bodies.offset(t)), t.radius]);
    this.frame = { ...units, ...camera.frame(width, height, bodies.followed()), ...bodies.lights(),
      sun: [...bodies.sun, 0], shades: [...balls, ...new Array(16).fill(0)].slice(0, 16),
      shadow_tint: tint.map((c) => (solid ? 0.1 + 0.22 * c : 0.15)),
      mapped: look.range ? 1 : 0, range: look.range ? [look.range[0], 1 / (look.range[1] - look.range[0])] : [0, 1],
      see_through: look.particles || types.some((type) => look[type]) ? 1 : 0 };
    device.bind(units.particles, bodies.particles);
    device.bind(units.scale, hasSign(look.color) ? this.scales.signed : this.scales.other);
    device.bind(units.tiles, this.tiles);
    this.drawLights();
    device.bind(units.sun_map, bodies.maps[0].texture);
    device.bind(units.sky_map, bodies.maps[1].texture);
    const { samples, behind } = this.targets;
    device.drawInto(samples);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.disable(gl.DEPTH_TEST);
    device.use(programs.sky, this.frame);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.enable(gl.DEPTH_TEST);
    if (look.terrain) this.drawTerrain();
    this.drawOpaque();
    this.resolve(samples, behind);
    if (look.solid) this.drawFlesh();
    if (look.terrain) this.drawGlass(true);
    this.resolve(samples, behind);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(left, bottom, width, height);
    gl.disable(gl.DEPTH_TEST);
    device.bind(units.image, behind.texture);
    device.use(programs.present, this.frame);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  resolve(from, to) {
    const { gl } = this.device;
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, from.framebuffer);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, to.framebuffer);
    gl.blitFramebuffer(0, 0, from.width, from.height, 0, 0, to.width, to.height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    this.device.drawInto(from);
    this.device.bind(units.behind, to.texture);
  }

  drawLights() {
    const { device, programs, bodies, frame, look } = this, { gl } = device;
    bodies.maps.forEach((map, light) => {
      // No map may be bound while it is drawn.
      device.bind(units.sun_map + light, null);
      device.drawInto(map);
      gl.clearColor(0, 0, 0, 0);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      if (!device.floats) return;
      // The surfaces nearest to the sun; below the sky the highest and the lowest of all.
      (light === 0 ? gl.enable : gl.disable).call(gl, gl.DEPTH_TEST);
      if (light === 1) {
        gl.enable(gl.BLEND);
        gl.blendEquation(gl.MAX);
      }
      if (look.solid) {
        device.use(programs.lightSkin, frame, { light });
        this.drawSkins(() => true);
        if (bodies.rods) {
          device.use(programs.lightRods, frame, { light, offset: [0, 0, 0] });
          this.drawMesh(bodies.rods);
        }
      }
      if (look.solid || look.particles) {
        device.use(programs.lightBalls, frame, { light });
        this.drawBalls();
      }
      gl.disable(gl.BLEND);
      gl.blendEquation(gl.FUNC_ADD);
      device.bind(units.sun_map + light, map.texture);
      gl.generateMipmap(gl.TEXTURE_2D);
    });
    gl.enable(gl.DEPTH_TEST);
  }

  drawSkins(prepare) {
    const { gl } = this.device, { skin, skins: { parts } } = this.bodies;
    gl.bindVertexArray(skin.vao);
    for (const part of parts)
      if (part.count > 0 && prepare(part.body)) gl.drawElements(gl.TRIANGLES, part.count, gl.UNSIGNED_INT, 4 * part.first);
    gl.bindVertexArray(null);
  }

  drawBalls() {
    const { gl } = this.device, { balls, facts } = this.bodies;
    gl.bindVertexArray(balls.vao);
    if (facts.balls.length > 0) gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, facts.balls.length);
    gl.bindVertexArray(null);
  }

  drawMesh(mesh) {
    const { gl } = this.device;
    gl.bindVertexArray(mesh.vao);
    gl.drawElements(gl.TRIANGLES, mesh.count, gl.UNSIGNED_INT, 0);
    gl.bindVertexArray(null);
  }

  blended(draw) {
    const { gl } = this.device;
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    draw();
    gl.disable(gl.BLEND);
  }

  drawTerrain() {
    const { device, programs, bodies, frame } = this, { gl } = device;
    gl.enable(gl.CULL_FACE);
    for (const { facts, mesh } of bodies.terrain) {
      if (!mesh || facts.glass) continue;
      const offset = bodies.offset(facts);
      device.use(programs.solid, frame, { offset, place: plus(facts.place, offset) });
      this.drawMesh(mesh);
    }
    gl.disable(gl.CULL_FACE);
    this.drawPlanes(false);
    this.drawGlass(false);
  }

  drawPlanes(fromBehind) {
    const { device, programs, bodies, frame, view } = this, { gl } = device;
    const square = (program, normal, point, reach, ...more) => {
      const above = dot(normal, minus(frame.target, point));
      device.use(program, frame, { plane_normal: normal, plane_point: [...minus(frame.target, times(above, normal)), reach * frame.eye[3]] }, ...more);
      gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    };
    for (const { facts, hole } of bodies.terrain) {
      if (!facts.flat) continue;
      const offset = bodies.offset(facts), point = plus(facts.flat.point, offset);
      const behind = dot(facts.flat.normal, minus(frame.eye.slice(0, 3), point)) < 0;
      if (behind !== fromBehind) continue;
      const more = hole ? [{ hole_u: facts.surface.across.slice(0, 3), hole_v: facts.surface.across.slice(3), hole_middle: point, hole_half: facts.surface.half }] : [];
      if (hole) device.bind(units.hole, hole);
      const draw = () => square(hole ? programs.holed : programs.ground, facts.flat.normal, point, 28, ...more);
      if (behind) this.blended(draw);
      else draw();
    }
    if (fromBehind || view.ground === undefined) return;
    gl.depthMask(false);
    this.blended(() => square(programs.grid, [0, 1, 0], [0, view.ground, 0], 8));
    gl.depthMask(true);
  }

  drawGlass(near) {
    const { device, programs, bodies, frame } = this, { gl } = device;
    if (near) this.drawPlanes(true);
    if (!bodies.terrain.some(({ facts, mesh }) => mesh && facts.glass)) return;
    gl.enable(gl.CULL_FACE);
    gl.cullFace(near ? gl.BACK : gl.FRONT);
    gl.depthMask(false);
    this.blended(() => {
      for (const { facts, mesh } of bodies.terrain) {
        if (!mesh || !facts.glass) continue;
        device.use(programs.glass, frame, { offset: bodies.offset(facts), near_side: near ? 1 : 0 });
        this.drawMesh(mesh);
      }
    });
    gl.depthMask(true);
    gl.cullFace(gl.BACK);
    gl.disable(gl.CULL_FACE);
  }

  // Rods, balls, particles, springs, cords and cloth.
  drawOpaque() {
    const { device, programs, bodies, frame, look, view } = this, { gl } = device, { facts } = bodies;
    if (look.solid && bodies.rods) {
      device.use(programs.rods, frame, { base_color: [0.94, 0.94, 0.94], offset: [0, 0, 0] });
      this.drawMesh(bodies.rods);
    }
    gl.enable(gl.SAMPLE_ALPHA_TO_COVERAGE);
    if (look.solid || look.particles) {
      device.use(programs.balls, frame);
      this.drawBalls();
    }
    if (look.particles) {
      device.use(programs.particles, frame, { radius: 0.16 * facts.spacing, base_color: look.tint ?? facts.bodies[0].color });
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, facts.particles);
    }
    gl.disable(gl.SAMPLE_ALPHA_TO_COVERAGE);
    for (const type of types)
      if (look[type]) this.drawRibbons(type, { radius: springRadius[type] * facts.spacing, fades: 0, base_color: view.springColors[type] });
    if (!look.solid) return;
    this.blended(() => this.drawSkins((body) => {
      if (body.style !== "sheet") return false;
      device.use(programs.sheet, frame, { base_color: this.colorOf(body) });
      return true;
    }));
    this.drawCords();
  }

  drawRibbons(name, uniforms) {
    const { device, programs, frame, look, bodies: { ribbons } } = this, { gl } = device;
    if (!ribbons[name]) return;
    device.use(programs.springs, frame, { ...uniforms, from_ends: look.color === "speed" ? 1 : 0 });
    gl.bindVertexArray(ribbons[name].array.vao);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, ribbons[name].count);
    gl.bindVertexArray(null);
  }

  // Of nets. They cover what is behind them in part, and so hide nothing that is drawn later: flesh is drawn between two passes.
  drawCords() {
    const { look, view, bodies: { facts }, device: { gl } } = this;
    if (!drawsCords(look)) return;
    const base_color = look.color === "type" ? view.springColors.structural : look.tint ?? [0.035, 0.04, 0.055];
    gl.depthMask(false);
    this.blended(() => this.drawRibbons("cords", { radius: springRadius.structural * facts.spacing, fades: 1, base_color }));
    gl.depthMask(true);
  }

  colorOf(body) {
    return this.look.color === "material" ? this.look.tint ?? body.color : this.view.neutral;
  }

  drawFlesh() {
    const { device, programs, frame } = this, { gl } = device, { samples, thickness } = this.targets;
    const flesh = (body) => body.style === "flesh";
    if (!this.bodies.facts.bodies.some(flesh)) return;
    device.bind(units.thickness_map, null);
    device.drawInto(thickness);
    gl.clear(gl.COLOR_BUFFER_BIT);
    if (device.floats) {
      gl.disable(gl.DEPTH_TEST);
      gl.enable(gl.BLEND);
      gl.blendFunc(gl.ONE, gl.ONE);
      device.use(programs.thickness, frame);
      this.drawSkins(flesh);
      gl.disable(gl.BLEND);
      gl.enable(gl.DEPTH_TEST);
    }
    device.bind(units.thickness_map, thickness.texture);
    device.drawInto(samples);
    this.drawSkins((body) => {
      if (!flesh(body)) return false;
      device.use(programs.jelly, frame, { base_color: this.colorOf(body), reach: body.reach });
      return true;
    });
    this.drawCords();
  }
}
