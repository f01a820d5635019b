#pragma once

// Attributes of an instance beside its master, as a table: a new one is a field of Instance and a row.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "compiler/graph/graph.h"

namespace graftal {

/// Values bit by bit: equal where the values are. -0 equals 0.
class AttributeWords {
  public:
    void put(std::uint64_t word) { words_.at(count_++) = word; }
    void put(double value) { put(std::bit_cast<std::uint64_t>(value == 0 ? 0.0 : value)); }

    std::span<const std::uint64_t> words() const { return {words_.data(), count_}; }
    bool operator==(const AttributeWords&) const = default;

  private:
    std::array<std::uint64_t, 24> words_{};
    std::size_t count_ = 0;
};

struct Attribute {
    void (*put)(const Instance& instance, AttributeWords& words);
    bool (*equal)(const Graph& a, const Instance& x, const Graph& b, const Instance& y);
    /// A line of `.inst` text, indented; "" where nothing is stated.
    std::string (*text)(const Graph& graph, const Instance& instance);
    /// Why no graph may have it, for "the instance ..."; "" if it may.
    std::string (*fault)(const Graph& graph, const Instance& instance);
};

std::span<const Attribute> instance_attributes();

/// All of an instance except its master, within one graph.
AttributeWords attribute_words(const Instance& instance);

/// Instances of two graphs, materials by their values.
bool equal_attributes(const Graph& a, const Instance& x, const Graph& b, const Instance& y);

/// "KEY: 1, 2.5, 3", a line of `.inst` text.
std::string numbers_line(std::string_view key, std::span<const double> numbers);

} // namespace graftal
