// Bytes -> a valid graph -> every pass: no crash, and no law of passes broken.

#include <cstddef>
#include <cstdint>

#include "compiler/support/check.h"
#include "tests/property/meaning.h"
#include "tests/property/random_graph.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace graftal;
    testing::Choices choices(std::span(data, size));
    const Graph graph = testing::random_graph(choices, {.max_objects = 12, .max_instances = 4});
    const testing::LawCheck check = testing::check_laws(model_passes(), {graph, {}}, 3, 60);
    GRAFTAL_CHECK(check.violation.empty(), check.violation);
    return 0;
}
