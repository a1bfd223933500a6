// Blocks of bodies of cells, their particles and springs: src/model/cell_blocks.h.
#define OWN_ROW 4u  // of nine: those of the plane before, of the own plane, of the next one

layout(std430, binding = BINDING_CELLS) restrict readonly buffer CellWords { uint cell_words[]; };

// Where there is no such block any will do: no spring leads there.
uint block_at(CellBody body, int at) { return cell_words[clamp(at, int(body.first_block), int(body.last_block))]; }

// The particle at a place from −2 to 5 of a block. Those before and behind it in its row are numbered on.
uint particle_at(CellBody body, uint block, int place) {
  int inside = bitCount(block & ((1u << max(place, 0)) - 1u) & ((1u << BLOCK_PLACES) - 1u));
  int before = inside + min(place, 0) + max(place - int(BLOCK_PLACES), 0);
  return uint(clamp(int(block >> BLOCK_PLACES) + before, int(body.first_particle), int(body.last_particle)));
}

// Record n: its first word, behind which its patterns are numbered, by place. A pattern's springs are found row by row:
// `steps` from 0 to 2 lead back, straight and forth there; of those over two steps there is one.
#ifdef ASPIC_MIXED
#define RECORDS mixed_count
#define RECORD(n) (mixed_first + MIXED_WORDS * (n))
#define NO_CLASS ((1u << ASPIC_MIXED) - 1u)

// Classes of ASPIC_MIXED bits, 8 or 16, four of them.
struct Row {
  uint low, high;
};

struct Pattern {
  uint lower, upper;            // where its halves begin
  Row lower_ends, upper_ends;  // of springs over two steps, and of the next in the own row
};

Row row_at(uint half_first, uint n) {
#if ASPIC_MIXED == 8
  return Row(cell_words[half_first + n], 0u);
#else
  return Row(cell_words[half_first + 2u * n], cell_words[half_first + 2u * n + 1u]);
#endif
}

uint class_in(Row row, uint n) {
#if ASPIC_MIXED == 8
  return row.low >> (8u * n) & NO_CLASS;
#else
  return (n < 2u ? row.low : row.high) >> (16u * (n % 2u)) & NO_CLASS;
#endif
}

Pattern pattern_of(CellBody body, uint record, uint place) {
  uint numbers = cell_words[record + 1u + place];
  uint lower = halves_first + HALF_WORDS(ASPIC_MIXED) * (numbers & 0xffffu);
  uint upper = halves_first + HALF_WORDS(ASPIC_MIXED) * (numbers >> 16);
  return Pattern(lower, upper, row_at(lower, 0u), row_at(upper, 0u));
}

Row row_of(Pattern pattern, uint r, uint d) {
  if (r < OWN_ROW) return row_at(pattern.lower, r + 1u);
  if (r > OWN_ROW) return row_at(pattern.upper, r - OWN_ROW);
  uint back = class_in(pattern.lower_ends, 3u), forth = class_in(pattern.upper_ends, 3u);
#if ASPIC_MIXED == 8
  return Row(back | NO_CLASS << 8 | forth << 16, 0u);
#else
  return Row(back | NO_CLASS << 16, forth);
#endif
}

Row ends_of(Pattern pattern, uint s, uint d) {
  return Row(class_in(s < 3u ? pattern.lower_ends : pattern.upper_ends, s % 3u), 0u);
}

bool find_spring(CellBody body, Row row, uint steps, SpringClass plain, out SpringClass spring) {
  uint found = class_in(row, steps);
  spring = spring_class(body.first_class + (found == NO_CLASS ? 0u : found));
  spring.cord = 0u;  // lattices have none, which need not be read
  return found != NO_CLASS;
}

uint first_class(CellBody body, Pattern pattern) { return body.first_class; }
#else
#define RECORDS plain_count
#define RECORD(n) (plain_first + PLAIN_WORDS * (n))

struct Row {
  uint joined;
};

struct Pattern {
  uint joined;  // bit d: there is a spring in direction d
  uint first_class;
};

Pattern pattern_of(CellBody body, uint record, uint place) {
  uint number = cell_words[record + 1u + place / 2u] >> (16u * (place % 2u)) & 0xffffu;
  return Pattern(cell_words[patterns_first + 2u * number],
                 body.first_class + cell_words[patterns_first + 2u * number + 1u]);
}

Row row_of(Pattern pattern, uint r, uint d) {
  uint joined = pattern.joined >> d;
  return Row(r == OWN_ROW ? (joined & 1u) | (joined & 2u) << 1 : joined);
}

Row ends_of(Pattern pattern, uint s, uint d) { return Row(pattern.joined >> d); }

bool find_spring(CellBody body, Row row, uint steps, SpringClass plain, out SpringClass spring) {
  spring = plain;
  spring.cord = 0u;
  return (row.joined >> steps & 1u) != 0u;
}

uint first_class(CellBody body, Pattern pattern) { return pattern.first_class; }
#endif
