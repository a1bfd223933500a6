// Lists and items of partners. Which place a body gets is arbitrary, what it holds is not: every list and every
// body's items come in ascending partner index.
layout(std430, binding = BINDING_BALL_WORK) restrict buffer WorkBlock {
  BallWork work;
  uint lists[];
};
layout(std430, binding = BINDING_BALL_ITEMS) restrict buffer ItemsBlock { BallItem items[]; };

// More than any device holds: past it nothing is added, so that sums do not wrap.
const uint too_much = 0x40000000u;

// Rows of BALL_GROUPS_X groups for so many invocations.
uint rows_for(uint invocations) {
  uint row = BALL_GROUPS_X * uint(ASPIC_GROUP_SIZE);
  return (invocations + row - 1u) / row;
}

void reset_work() {
  work.lists_used = 0u;
  work.items_used = 0u;
  work.word_groups = uint[3](BALL_GROUPS_X, 0u, 1u);
  work.tally_groups = uint[3](BALL_GROUPS_X, rows_for(particle_count), 1u);
  work.item_groups = uint[3](BALL_GROUPS_X, 0u, 1u);
}

// Room for `count` words or items in a row, or NO_BODY: then the step has to be repeated with more room.
uint take_list(uint count) {
  uint first = work.lists_used < too_much ? atomicAdd(work.lists_used, count) : too_much;
  if (first <= work.list_capacity && count <= work.list_capacity - first) return first;
  mark_full();
  return NO_BODY;
}

uint take_items(uint count) {
  uint first = work.items_used < too_much ? atomicAdd(work.items_used, count) : too_much;
  if (first > work.item_capacity || count > work.item_capacity - first) {
    mark_full();
    return NO_BODY;
  }
  uint end = first + count;
  atomicMax(work.word_groups[1], rows_for(ITEM_WORDS * end));
  atomicMax(work.tally_groups[1], rows_for(ITEM_WORDS * end + particle_count));
  atomicMax(work.item_groups[1], rows_for(end));
  return first;
}

// Of candidates first, first + 256, … in steps of a block, `total` items.
void write_item(uint item, uint body, uint kind, uint first, uint total) {
  items[item].body = body;
  items[item].kind = kind;
  items[item].first = first;
  items[item].total = total;
  items[item].acting = 0u;
  items[item].overlapping = 0u;
}
