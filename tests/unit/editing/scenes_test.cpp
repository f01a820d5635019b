// Questions of editors, over every scene.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "compiler/editing/complete.h"
#include "compiler/editing/format.h"
#include "compiler/editing/hover.h"
#include "compiler/editing/maps/maps.h"
#include "compiler/editing/names/names.h"
#include "compiler/editing/rename.h"
#include "compiler/languages/lower.h"
#include "compiler/support/counter_random.h"
#include "compiler/support/text_encoding.h"
#include "runtime/system/disk_files.h"

namespace graftal {
namespace {

struct Scene {
    std::string path, text;
};

std::vector<Scene> scenes() {
    std::vector<Scene> all;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(GRAFTAL_SOURCE_DIR "/scenes")) {
        const std::string ending = entry.path().extension().string();
        if (ending != ".lsys" && ending != ".rifs" && ending != ".inst") continue;
        std::ifstream file(entry.path());
        all.push_back({entry.path().string(),
                       decoded_text({std::istreambuf_iterator<char>(file), {}}, OtherBytes::kept)});
    }
    std::ranges::sort(all, {}, &Scene::path);
    return all;
}

/// The graph after few steps, where that is soon made.
std::optional<Graph> lowered(const std::string& path, const std::string& text) {
    constexpr double seconds = 0.03; // counted: the same models are compared on each machine
    StageWork work(seconds);
    LowerOptions options;
    options.steps = 3;
    options.max_objects = 20'000;
    options.may_leave_out_colours = true;
    LowerHelp help;
    help.files = &disk_files();
    help.control.work = &work;
    SourceMap sources;
    Diagnostics diagnostics;
    try {
        return lower_text(path, text, options, sources, diagnostics, help).graph;
    } catch (const OutOfWork&) {
        return std::nullopt;
    }
}

TEST(Scenes, LayoutChangesNoModel) {
    std::size_t compared = 0, changed = 0;
    for (const auto& [path, text] : scenes()) {
        const Document document(path, text);
        EXPECT_FALSE(document.findings().has_errors()) << path;
        const std::string once = applied(text, format(document));
        const std::string twice = applied(once, format(Document(path, once)));
        EXPECT_EQ(once, twice) << path;
        if (once == text) continue;
        ++changed;
        const std::optional<Graph> before = lowered(path, text), after = lowered(path, once);
        ASSERT_EQ(before.has_value(), after.has_value()) << path;
        if (!before) continue;
        EXPECT_TRUE(equal(*before, *after)) << path;
        ++compared;
    }
    EXPECT_GT(compared, 30u);
    EXPECT_GE(changed, compared);
}

/// Blanks where white space may be, at random.
std::string untidy(const std::string& text, CounterRandom random) {
    std::string out;
    std::uint64_t n = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const double draw = CounterRandom::unit(random(n++));
        if (text[i] == '\n' && draw < 0.2) out += "  ";
        out += text[i];
        if (text[i] == '\n' && i > 0 && text[i - 1] == '\n' && draw < 0.5) out += "\n";
        if (text[i] == '\n' && draw > 0.7) out += draw > 0.85 ? "\t" : "   ";
    }
    return out;
}

TEST(Scenes, LayoutOfUntidyTextsChangesNoModel) {
    const CounterRandom random(7);
    std::uint64_t number = 0;
    for (const auto& [path, text] : scenes()) {
        if (text.size() > 1500) continue;
        const std::string messy = untidy(text, random.sequence(number++));
        const Document document(path, messy);
        if (document.findings().has_errors()) continue; // an empty line may end a statement
        const std::string tidy = applied(messy, format(document));
        EXPECT_EQ(applied(tidy, format(Document(path, tidy))), tidy) << path;
        const std::optional<Graph> before = lowered(path, messy), after = lowered(path, tidy);
        ASSERT_EQ(before.has_value(), after.has_value()) << path;
        if (before) {
            EXPECT_TRUE(equal(*before, *after)) << path;
        }
        for (std::size_t at = 0; (at = tidy.find('\n', at)) != std::string::npos; ++at)
            EXPECT_TRUE(at == 0 || tidy[at - 1] != ' ' || tidy.find("/*") < at) << path << " " << at;
    }
}

TEST(Scenes, AnswerAtEachPlace) {
    std::size_t offered = 0, told = 0, defined = 0;
    const CounterRandom random(3);
    std::uint64_t number = 0;
    for (const auto& [path, text] : scenes()) {
        const Document document(path, text);
        for (int i = 0; i < 6; ++i) {
            const auto offset = static_cast<std::uint32_t>(random(number++) % (text.size() + 1));
            offered += complete(document, offset).items.size();
            told += hover(document, offset) ? 1 : 0;
            defined += definition(document, offset) ? 1 : 0;
        }
        maps_of(document);
    }
    EXPECT_GT(offered, 1000u);
    EXPECT_GT(told, 300u);
    EXPECT_GT(defined, 100u);
}

/// Another name for each kind of thing in each scene: the graph stays, up to that name.
TEST(Scenes, RenamedLetsChangeNoModel) {
    std::size_t renamed = 0;
    for (const auto& [path, text] : scenes()) {
        if (text.size() > 1500) continue;
        const Document document(path, text);
        for (const NamedThing& thing : names_of(document)) {
            const bool number = thing.kind == NameKind::let || thing.kind == NameKind::parameter ||
                                thing.kind == NameKind::variable || thing.kind == NameKind::local;
            if (!number || thing.definitions.empty() || thing.uses.empty()) continue;
            const Renaming result = rename(document, thing.uses.front().begin, "zz_other");
            ASSERT_EQ(result.refusal, "") << path << " " << thing.name;
            const std::optional<Graph> before = lowered(path, text);
            const std::optional<Graph> after = lowered(path, applied(text, result.edits));
            ASSERT_EQ(before.has_value(), after.has_value()) << path << " " << thing.name;
            if (before) {
                EXPECT_TRUE(equal(*before, *after)) << path << " " << thing.name;
            }
            ++renamed;
            break; // one a scene
        }
    }
    EXPECT_GT(renamed, 30u);
}

TEST(Scenes, BrokenTextsGetAnswersToo) {
    const CounterRandom random(11);
    std::uint64_t number = 0;
    for (const auto& [path, text] : scenes()) {
        if (text.size() > 3000) continue;
        std::string broken = text;
        for (int i = 0; i < 4; ++i) {
            const std::size_t at = random(number++) % broken.size();
            constexpr std::string_view bytes = "{}()[]<>\"#/*\n;:,~@\xFF\xE2 aF9.-";
            broken[at] = bytes[random(number++) % bytes.size()];
        }
        broken.resize(random(number++) % (broken.size() + 1));
        const Document document(path, broken);
        for (int i = 0; i < 4; ++i) {
            const auto offset = static_cast<std::uint32_t>(random(number++) % (broken.size() + 1));
            complete(document, offset);
            hover(document, offset);
            definition(document, offset);
            rename(document, offset, "zz");
        }
        applied(broken, format(document));
        maps_of(document);
        digraphs_of(document);
    }
}

} // namespace
} // namespace graftal
