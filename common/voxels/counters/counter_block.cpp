#include "voxlist/voxels/counters/counter_block.h"

#include <algorithm>
#include <cstring>

namespace voxlist {
namespace {

// The widest that every processor has.
using Word = std::uint64_t __attribute__((vector_size(16)));
constexpr std::size_t kWords = 2;

struct Planes {
  Word bit[4];
};

Word all_or_none(unsigned number, unsigned bit) {
  const std::uint64_t word = (number >> bit & 1) != 0 ? ~std::uint64_t{0} : 0;
  return Word{word, word};
}

Word select(const Word& where, const Word& yes, const Word& no) {
  return no ^ ((yes ^ no) & where);
}

Word any(const Planes& v) { return v.bit[0] | v.bit[1] | v.bit[2] | v.bit[3]; }

// Where a value exceeds a number.
Word above(const Planes& v, unsigned number) {
  Word out{};
  for (unsigned i = 0; i < 4; ++i) out = (number >> i & 1) != 0 ? out & v.bit[i] : out | v.bit[i];
  return out;
}

void set(Planes& v, const Word& where, unsigned number) {
  for (unsigned i = 0; i < 4; ++i) v.bit[i] = select(where, all_or_none(number, i), v.bit[i]);
}

// Adds where it is said; what would exceed the highest becomes that.
void add(Planes& v, const Word& where, unsigned number, unsigned highest) {
  Word carry{};
  for (unsigned i = 0; i < 4; ++i) {
    const Word n = all_or_none(number, i) & where, both = v.bit[i] & n, either = v.bit[i] ^ n;
    v.bit[i] = either ^ carry;
    carry = both | (either & carry);
  }
  set(v, carry | above(v, highest), highest);
}

// Takes away where it is said; what would fall below 1 becomes that.
void subtract(Planes& v, const Word& where, unsigned number) {
  Word borrow{};
  for (unsigned i = 0; i < 4; ++i) {
    const Word n = all_or_none(number, i) & where, differ = v.bit[i] ^ n;
    const Word next = (~v.bit[i] & n) | (~differ & borrow);
    v.bit[i] = differ ^ borrow;
    borrow = next;
  }
  set(v, borrow | (where & ~any(v)), 1);
}

Word load(const std::uint64_t* from) {
  Word word;
  std::memcpy(&word, from, sizeof word);
  return word;
}

Planes load(const CounterBlock& block, std::size_t word) {
  return {{load(&block.planes[0][word]), load(&block.planes[1][word]), load(&block.planes[2][word]),
           load(&block.planes[3][word])}};
}

Word difference(const Planes& a, const Planes& b) {
  return (a.bit[0] ^ b.bit[0]) | (a.bit[1] ^ b.bit[1]) | (a.bit[2] ^ b.bit[2]) |
         (a.bit[3] ^ b.bit[3]);
}

void store(const Planes& planes, std::size_t word, CounterBlock& block) {
  for (std::size_t p = 0; p < 4; ++p)
    std::memcpy(&block.planes[p][word], &planes.bit[p], sizeof(Word));
}

bool is_empty(const Word& word) { return (word[0] | word[1]) == 0; }

template <class Of>
BlockBits bits_of(const CounterBlock& block, const Of& of) {
  BlockBits bits;
  for (std::size_t i = 0; i < kWordsInBlock; i += kWords) {
    const Word word = of(load(block, i));
    std::memcpy(&bits[i], &word, sizeof word);
  }
  return bits;
}

}  // namespace

BlockBits CounterBlock::known() const {
  return bits_of(*this, [](const Planes& v) { return any(v); });
}

unsigned CounterBlock::value(std::size_t cell) const {
  unsigned value = 0;
  for (unsigned p = 0; p < 4; ++p)
    value |= static_cast<unsigned>(planes[p][cell / 64] >> cell % 64 & 1) << p;
  return value;
}

void CounterBlock::set(std::size_t cell, unsigned value) {
  const std::uint64_t bit = std::uint64_t{1} << cell % 64;
  for (unsigned p = 0; p < 4; ++p) {
    std::uint64_t& word = planes[p][cell / 64];
    word = (value >> p & 1) != 0 ? word | bit : word & ~bit;
  }
}

CounterUpdate::CounterUpdate(const CounterRule& rule)
    : hit_(static_cast<unsigned>(rule.hit)),
      pass_(static_cast<unsigned>(rule.pass)),
      zero_(static_cast<unsigned>(1 - rule.lowest)),
      highest_(static_cast<unsigned>(1 - rule.lowest + rule.highest)) {}

bool CounterUpdate::count(Cells passed, Cells hit, CounterBlock& block) const {
  Word changed{};
  for (std::size_t i = 0; i < kWordsInBlock; i += kWords) {
    const Word hits = load(&hit[i]), passes = load(&passed[i]) & ~hits;
    if (is_empty(hits | passes)) continue;
    const Planes before = load(block, i);
    Planes v = before;
    set(v, (hits | passes) & ~any(v), zero_);
    if (!is_empty(hits)) add(v, hits, hit_, highest_);
    subtract(v, passes, pass_);
    store(v, i, block);
    changed |= difference(before, v);
  }
  return !is_empty(changed);
}

BlockBits CounterUpdate::occupied(const CounterBlock& block) const {
  return bits_of(block, [&](const Planes& v) { return above(v, zero_ - 1); });
}

}  // namespace voxlist
