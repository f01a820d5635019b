#pragma once

#include <cstdint>
#include <string>

namespace graftal {

/// Models at random, of flat faces in general position: maps that scale, stretch, shear, turn and mirror, any
/// digraph, tints of every alpha, materials, terminals. Every cycle contracts. Parts overlap, so that
/// which is in front matters; no two faces lie in one plane, where it would be left to rounding.
std::string random_rifs(std::uint64_t seed);
std::string random_inst(std::uint64_t seed);
/// A plant of round branches, which lie in each other where they meet.
std::string random_lsys(std::uint64_t seed);

} // namespace graftal
