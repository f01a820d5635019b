// `.rifs` from text to verified graph, printed and read back: any input gives a graph or diagnostics, soon.

#include "tests/fuzz/round_trip.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    graftal::check_model_text("no_such_folder/fuzz.rifs", data, size);
    return 0;
}
