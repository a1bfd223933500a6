// A body as it looks at its partners. Expects ball_phase.

// start: velocity at the start of the step; radius: 0 for a particle.
struct Seeker {
  vec3 x;
  vec3 v;
  vec3 start;
  float radius;
  uint kind;
  uint index;
};

// A partner as the seeker sees it. gap: normal towards the seeker, distance; dv, dv_0: the seeker's velocity less its.
struct Partner {
  vec4 gap;
  vec3 dv;
  vec3 dv_0;
};

Partner partner(Seeker seeker, uint kind, uint index) {
  if (kind == KIND_PARTICLE) {
    Particle p = end_particle(index);
    precise vec3 e = seeker.x - p.position.xyz, dv = seeker.v - p.velocity.xyz;
    precise vec3 dv_0 = seeker.start - start_particle(index).velocity.xyz;
    return Partner(pair_gap(e, seeker.radius, false), dv, dv_0);
  }
  Ball b = ball_in(slot_before(ball_phase), index);
  precise vec3 e = seeker.x - b.position.xyz, dv = seeker.v - b.velocity.xyz;
  precise vec3 dv_0 = seeker.start - b.start_velocity.xyz;
  precise float reach = b.position.w;
  if (seeker.kind == KIND_BALL) reach = seeker.radius + reach;
  return Partner(pair_gap(e, reach, seeker.kind == KIND_PARTICLE || seeker.index < index), dv, dv_0);
}

// Balls that wait and the body itself are no partners.
bool is_partner(Seeker seeker, uint kind, uint index) {
  if (kind == KIND_PARTICLE) return true;
  if (seeker.kind == KIND_BALL && seeker.index == index) return false;
  return ball_in(slot_before(ball_phase), index).velocity.w != 0.0;
}

// Whether a partner may be nearer than ε: a rejected one is further away, far beyond rounding.
bool may_contact(Seeker seeker, uint kind, uint index) {
  precise vec3 x = vec3(0.0);
  precise float reach = 0.0;
  if (kind == KIND_PARTICLE) {
    x = end_particle(index).position.xyz;
  } else {
    precise vec4 position = balls[slot_before(ball_phase) * ball_count + index].position;
    x = position.xyz;
    reach = position.w;
  }
  precise vec3 e = seeker.x - x;
  precise float limit = 1.01 * ((seeker.radius + reach) + contact_distance);
  return !(dot3(e, e) > limit * limit);
}

Seeker seeking_ball(uint b) {
  Ball ball = ball_in(slot_before(ball_phase), b);
  return Seeker(ball.position.xyz, ball.velocity.xyz, ball.start_velocity.xyz, ball.position.w, KIND_BALL, b);
}

Seeker seeking_particle(uint p) {
  Particle particle = end_particle(p);
  return Seeker(particle.position.xyz, particle.velocity.xyz, start_particle(p).velocity.xyz, 0.0, KIND_PARTICLE, p);
}

// By its place among all bodies.
Seeker seeking(uint body) {
  if (body < ball_count) return seeking_ball(body);
  return seeking_particle(body - ball_count);
}

// Whether this phase has pairs of such bodies.
bool phase_has(uint own_kind, uint kind) {
  if (ball_phase == BALL_PHASE_POSITIONS) return true;
  return (ball_phase == BALL_PHASE_BALLS) == (own_kind == KIND_BALL && kind == KIND_BALL);
}
