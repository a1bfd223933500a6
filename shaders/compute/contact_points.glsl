// The contacts of a point with a body: the first, then second sides, each with its normal force. An includer has body_contact_time, the
// places start_place(i) and stage_place(i) of particles, stage_velocity(i), at_end(), triangles and words.
#include "compute/contact_query.glsl"

// Where normal forces begin by now of bodies that overlapped in the initial state.
float back_of(CandidateGroup of) {
  precise float back = of.start_distance + of.spacing * body_contact_time;
  return back;
}

// The normal force k·(ρ − d), were there no motion; of one where a step may end, in which there is motion already.
float rest_of(CandidateGroup of, float d, float u) {
  precise float back = back_of(of);
  precise float reach = back < of.reach ? back : of.reach;
  precise float rest = of.contact_stiffness * (reach - d);
  if (at_end()) rest = rest + of.contact_damping * u;
  return rest;
}

void add(Looker p, uint record, uint k, vec4 gap, vec3 at) {
  uvec4 t = triangle_of(p, k);
  precise float b_0 = (1.0 - at.x) - at.y;
  precise vec3 share = vec3(b_0, at.x, at.y);
  precise vec3 own = over_carriers(p.of, stage_velocity(p.of.carrier0), stage_velocity(p.of.carrier1));
  precise vec3 other = over_corners(share, stage_velocity(t.x), stage_velocity(t.y), stage_velocity(t.z));
  precise vec3 relative = own - other;
  precise float u = dot3(gap.xyz, relative);
  precise float rest = rest_of(p.of, gap.w, u);
  precise vec4 normal = vec4(gap.xyz, normal_force_of(p.of, rest, u));
  records[record] = ContactRecord(normal, vec4(0.0, 0.0, 0.0, rest), uvec4(t.xyz, 0u), vec4(share, 0.0), vec4(0.0), vec4(0.0));
}

// How many contacts there are: the first of all sides, then of a closed body those of the other sides in front of which the
// point is.
uint contact(Looker p, uint first) {
  uint count = 0u, fronts = 0u, first_side = ANY_SIDE;
  bool closed = (p.of.flags & CONTACT_CLOSED) != 0u;
  precise float depth = back_of(p.of) < p.of.reach ? p.of.eased_depth : p.of.depth;
  uint rounds = closed ? CONTACT_SIDES + 1u : 1u;
  for (uint round = 0u; round < rounds; ++round) {
    uint side = round == 0u ? ANY_SIDE : round - 1u;
    if (round > 0u && (side == first_side || (fronts >> side & 1u) == 0u)) continue;
    uint in_front = 0u;
    ClosestPoint seen;
    uint k = nearest_of(p, side, in_front, seen);
    if (k == NO_TRIANGLE) return count;
    if (round == 0u) {
      fronts = in_front;
      first_side = triangle_of(p, k).w;
    }
    if (round > 0u && !straight_in_front(seen, p.of.range)) continue;
    precise vec4 gap;
    if (closed ? closed_gap(seen, p.of.range, depth, gap) : open_gap(seen, p.of.range, gap))
      add(p, first + count++, k, gap, seen.place);
  }
  return count;
}

void find(uint n) {
  CandidateGroup of = candidate_groups[n];
  precise vec3 start = over_carriers(of, start_place(of.carrier0), start_place(of.carrier1));
  precise vec3 place = over_carriers(of, stage_place(of.carrier0), stage_place(of.carrier1));
  precise vec3 normal = vec3(0.0);
  if ((of.flags & CONTACT_OPPOSING) != 0u) {
    precise vec3 N_0 = normal_of(of.normals_first0, of.normals_count0);
    precise vec3 N_1 = N_0;
    if (of.carrier1 != of.carrier0) N_1 = normal_of(of.normals_first1, of.normals_count1);
    normal = over_carriers(of, N_0, N_1);
  }
  uint count = contact(Looker(of, start, place, normal), first_record(n));
  records[first_record(n)].corner.w = count;
}
