#include "voxlist/voxels/voids/free_neighbours.h"

namespace voxlist {
namespace {

using Bits = std::uint64_t;

constexpr Bits kFirstColumn = 0x0101010101010101, kLastColumn = kFirstColumn << 7;

// Numbers of 64 cells, a bit of each in one word.
struct Small {
  Bits one = 0, two = 0;
};
struct Number {
  std::array<Bits, 5> bit{};
};

Bits carry_of(Bits a, Bits b, Bits c) { return (a & b) | (c & (a ^ b)); }

// A layer of a row of three blocks: each cell and its neighbours along x.
Small sum_along_x(Bits before, Bits here, Bits after) {
  const Bits left = (here << 1 & ~kFirstColumn) | (before >> 7 & kFirstColumn);
  const Bits right = (here >> 1 & ~kLastColumn) | (after << 7 & kLastColumn);
  return {left ^ here ^ right, carry_of(left, here, right)};
}

Bits from_below(Bits before, Bits here) { return here << 8 | before >> 56; }
Bits from_above(Bits here, Bits after) { return here >> 8 | after << 56; }

// Up to 9.
Number sum_along_y(const Small& before, const Small& here, const Small& after) {
  const Bits low_one = from_below(before.one, here.one), low_two = from_below(before.two, here.two);
  const Bits up_one = from_above(here.one, after.one), up_two = from_above(here.two, after.two);
  const Bits carry = carry_of(low_one, here.one, up_one);
  const Bits twos = low_two ^ here.two ^ up_two, fours = carry_of(low_two, here.two, up_two);
  const Bits second = twos & carry;
  return {{low_one ^ here.one ^ up_one, twos ^ carry, fours ^ second, fours & second, 0}};
}

Number sum(const Number& a, const Number& b) {
  Number out;
  Bits carry = 0;
  for (std::size_t i = 0; i < out.bit.size(); ++i) {
    out.bit[i] = a.bit[i] ^ b.bit[i] ^ carry;
    carry = carry_of(a.bit[i], b.bit[i], carry);
  }
  return out;
}

// Where a number is not below another one: what is subtracted is not borrowed for.
Bits at_least(const Number& a, unsigned least) {
  Bits borrow = 0;
  for (std::size_t i = 0; i < a.bit.size(); ++i) {
    const Bits taken = (least >> i & 1) != 0 ? ~Bits{0} : 0;
    borrow = (~a.bit[i] & (taken | borrow)) | (taken & borrow);
  }
  return ~borrow;
}

// A layer of the block in the middle, counted from its lowest; -1 and 8 are of the blocks below
// and above.
Number sum_of_layer(const BlocksAround& blocks, int layer) {
  const std::size_t level = layer < 0 ? 0 : layer < kBlockEdge ? 1 : 2;
  const auto z = static_cast<std::size_t>(layer & 7);
  std::array<Small, 3> rows;
  for (std::size_t y = 0; y < 3; ++y) {
    const auto word = [&](std::size_t x) {
      const VoxelBlock* block = blocks[9 * level + 3 * y + x];
      return block ? (*block)[z] : Bits{0};
    };
    rows[y] = sum_along_x(word(0), word(1), word(2));
  }
  return sum_along_y(rows[0], rows[1], rows[2]);
}

// Four cells of each of four rows, spread to rows of eight.
Bits spread(Bits cells) {
  return (cells & 0xf) | (cells & 0xf0) << 4 | (cells & 0xf00) << 8 | (cells & 0xf000) << 12;
}

Bits gathered(Bits rows) {
  return (rows & 0xf) | (rows >> 4 & 0xf0) | (rows >> 8 & 0xf00) | (rows >> 12 & 0xf000);
}

}  // namespace

VoxelBlock in_rows(CellStore::Block words) {
  VoxelBlock block{};
  for (std::size_t z = 0; z < block.size(); ++z) {
    const std::size_t first = z < 4 ? 0 : 4;
    const auto part = [&](std::size_t word) {
      return spread(words[first + word] >> 16 * (z & 3) & 0xffff);
    };
    block[z] = part(0) | part(1) << 4 | part(2) << 32 | part(3) << 36;
  }
  return block;
}

BlockBits in_keys(const VoxelBlock& block) {
  BlockBits words{};
  for (std::size_t z = 0; z < block.size(); ++z) {
    const std::size_t first = z < 4 ? 0 : 4;
    const auto put = [&](std::size_t word, int shift) {
      words[first + word] |= gathered(block[z] >> shift) << 16 * (z & 3);
    };
    put(0, 0), put(1, 4), put(2, 32), put(3, 36);
  }
  return words;
}

VoxelBlock with_marked_around(const BlocksAround& blocks, unsigned fewest) {
  std::array<Number, kBlockEdge + 2> layers;
  for (int z = -1; z <= kBlockEdge; ++z)
    layers[static_cast<std::size_t>(z + 1)] = sum_of_layer(blocks, z);
  VoxelBlock result;
  for (std::size_t z = 0; z < result.size(); ++z)
    result[z] = at_least(sum(sum(layers[z], layers[z + 1]), layers[z + 2]), fewest);
  return result;
}

}  // namespace voxlist
