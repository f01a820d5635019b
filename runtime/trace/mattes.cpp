#include "runtime/trace/mattes.h"

#include <algorithm>
#include <bit>
#include <string>

namespace graftal {

namespace {

/// MurmurHash3_x86_32 with seed 0 (Appleby, public domain).
std::uint32_t murmur3(std::string_view text) {
    constexpr std::uint32_t first = 0xcc9e2d51, second = 0x1b873593;
    constexpr std::size_t word_bytes = 4;
    const auto word_at = [&](std::size_t begin) {
        std::uint32_t word = 0;
        for (std::size_t i = begin; i < std::min(begin + word_bytes, text.size()); ++i)
            word |= static_cast<std::uint32_t>(static_cast<unsigned char>(text[i])) << 8 * (i - begin);
        return std::rotl(word * first, 15) * second;
    };
    std::uint32_t hash = 0;
    std::size_t place = 0;
    for (; place + word_bytes <= text.size(); place += word_bytes)
        hash = std::rotl(hash ^ word_at(place), 13) * 5 + 0xe6546b64;
    hash ^= word_at(place); // of no bytes: 0
    hash ^= static_cast<std::uint32_t>(text.size());
    hash = (hash ^ hash >> 16) * 0x85ebca6b;
    hash = (hash ^ hash >> 13) * 0xc2b2ae35;
    return hash ^ hash >> 16;
}

} // namespace

std::uint32_t matte_id(std::string_view name) {
    constexpr std::uint32_t exponent_bits = 0x7f800000, lowest_of_exponent = 1u << 23;
    const std::uint32_t id = murmur3(name), exponent = id & exponent_bits;
    return exponent == 0 || exponent == exponent_bits ? id ^ lowest_of_exponent : id;
}

std::uint32_t matte_id(std::span<const std::uint32_t> way) {
    std::string bytes;
    for (const std::uint32_t number : way)
        for (int shift = 0; shift < 32; shift += 8)
            bytes.push_back(static_cast<char>(number >> shift & 0xff));
    return matte_id(bytes);
}

void MatteSum::add(const MatteIds& ids, double weight) {
    add(objects_, ids.object, weight);
    add(instances_, ids.instance, weight);
    add(materials_, ids.material, weight);
}

PixelMattes MatteSum::shares(double whole) const {
    return {largest(objects_, whole), largest(instances_, whole), largest(materials_, whole)};
}

void MatteSum::add(Parts& parts, std::uint32_t id, double weight) {
    if (id == 0) return;
    const auto known = std::ranges::find(parts, id, &Part::id);
    if (known != parts.end())
        known->weight += weight;
    else
        parts.push_back({id, weight});
}

MatteShares MatteSum::largest(Parts parts, double whole) {
    std::ranges::sort(parts, [](const Part& a, const Part& b) {
        return a.weight != b.weight ? a.weight > b.weight : a.id < b.id;
    });
    MatteShares shares{};
    for (std::size_t i = 0; i < std::min(parts.size(), shares.size()); ++i)
        shares[i] = {parts[i].id, static_cast<float>(parts[i].weight / whole)};
    return shares;
}

} // namespace graftal
