// A model and a command line through the whole program, in this process: any text and any options end with a
// status, in bounded time, and leave no files but the output. The first line of the text is `# LANGUAGE
// COMMAND OPTIONS`, the rest the model, which finds a picture and models of the other languages beside it.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/support/check.h"
#include "runtime/image_files/image_files.h"
#include "tests/fuzz/scratch.h"
#include "tests/fuzz/words.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/options.h"

using namespace graftal;

namespace {

/// What models may use: they stand beside it.
class Beside : public fuzz::Scratch {
  public:
    Beside() {
        write("part.inst", "inner k = 0.5 members 4\ncanonical object leaf { union: sphere scale: k }\n"
                           "object part { union: leaf, cube translate: k, 0, 0 }\n");
        write("part.rifs", "rifs part { map a { scale 1/2 translate <0, 1, 0> } map b { scale 1/3 } }\n");
        write("part.lsys", "lsys part { steps 2 axiom F F -> F[+F]F }\n");
        const Image picture{2, 2, 4, {1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 0, 1, 1, 1, 1}};
        GRAFTAL_CHECK(write_image(path("t.png"), picture, SampleFormat::srgb8).ok(),
                      "model fuzzer: a picture");
    }
};

/// What would only take longer is held down; what is refused or not stays as it is.
void hold(Options& options, const fuzz::Scratch& scratch) {
    StageOptions& compile = options.render.compile;
    compile.view.size = {std::min(compile.view.size.width, 40), std::min(compile.view.size.height, 30)};
    compile.lower.root = scratch.path("");
    compile.lower.max_objects = 2000;
    compile.lower.max_modules = 20'000;
    compile.lower.run_from = 256;
    compile.detail.memory_bytes = std::min<std::uint64_t>(compile.detail.memory_bytes, 8u << 20);
    options.render.limit_work(std::min(compile.detail.work_seconds, 0.02));
    options.render.threads = 1;
    options.quiet = true;
    options.render.antialias.reset();
    options.render.progressive = false;
    options.engine = find_engine("native");
    options.points.points = std::min<std::uint64_t>(options.points.points.value_or(2000), 2000);
    options.points.card.clear();
    options.render.keep.clear();
    options.file.most_bytes = options.file.fitted_bytes =
        std::min<std::uint64_t>(options.file.most_bytes, 1u << 20);
}

/// What a command writes to, in the folder; "" where it says something.
std::string output_of(const Options& options) {
    const std::string ending = std::filesystem::path(options.render.output).extension().string();
    const std::string_view command = options.command->name;
    if (command == "render" || command == "points") return "out" + (ending.empty() ? ".png" : ending);
    if (command == "compile") return ending == ".inc" ? "out.inc" : "out.pov";
    return command == "export" ? "out" + ending : "";
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const std::size_t line_end = std::min(text.find('\n'), size);
    std::vector<std::string> words = fuzz::words_of(text.substr(0, line_end));
    if (words.size() < 3 || words[0] != "#") return 0;
    const std::string language = words[1] == "rifs" || words[1] == "lsys" ? words[1] : "inst";
    static const Beside scratch;
    const std::string model = "model." + language;
    words.erase(words.begin(), words.begin() + 2);
    words.insert(words.begin() + 1, scratch.path(model));
    if (words[0] == "collage") words.insert(words.begin() + 1, scratch.path("t.png"));
    const auto arguments = fuzz::arguments_of(words);
    ParsedCommandLine parsed = parse_command_line(static_cast<int>(arguments.size()), arguments.data());
    if (!parsed.options) return 0;
    Options& options = *parsed.options;
    const std::string_view command = options.command->name;
    if (command == "animate" || command == "compare" || options.operands.size() != 1)
        return 0; // they start processes, or read what we have not made
    hold(options, scratch);
    const std::string output = output_of(options);
    options.operands = {scratch.path(model)};
    options.render.output = output.empty() ? "-" : scratch.path(output);
    scratch.write(model, text);
    const int status = options.command->run(options);
    GRAFTAL_CHECK(status == exit_done || status == exit_fault,
                  "model fuzzer: done, or the model is at fault");
    std::filesystem::remove(scratch.path(model));
    bool written = false;
    for (const auto& entry : std::filesystem::directory_iterator(scratch.path(""))) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with("part.") || name == "t.png") continue;
        GRAFTAL_CHECK(status == exit_done && name.starts_with("out"), "model fuzzer: leaves " + name);
        written |= name == output;
        std::filesystem::remove(entry.path());
    }
    GRAFTAL_CHECK(written == (status == exit_done && !output.empty()), "model fuzzer: the output is there");
    return 0;
}
