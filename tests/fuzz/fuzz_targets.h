#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/fuzz/syntax_mutator.h"

namespace graftal::fuzz {

/// What a file tests/fuzz/NAME_fuzzer.cpp tries.
struct Target {
    std::string name;
    int (*run)(const std::uint8_t* data, std::size_t size);
    bool texts = false; ///< its inputs have syntax trees
};

/// All of them.
std::vector<Target> targets();

/// A file's name and what is in it.
struct Input {
    std::string name;
    std::string bytes;
};

/// The files of a folder, by name.
std::vector<Input> files_of(const std::string& folder);

/// One of the inputs, changed: a text by its syntax tree, and now and then by its bytes, as other inputs are.
/// Requires at least one.
std::string changed(const Target& target, const std::vector<Input>& inputs, std::size_t most,
                    SyntaxMutator& mutator, testing::Choices& choices);

} // namespace graftal::fuzz
