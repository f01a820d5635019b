#include "tools/graftal/help/format.h"

#include <algorithm>
#include <string_view>
#include <vector>

namespace graftal {

namespace {

struct OptionGroup {
    const char* heading;
    std::vector<std::string_view> options;
};

/// The headings in the order of the help, and the options below each in theirs.
const std::vector<OptionGroup>& option_groups() {
    static const std::vector<OptionGroup> groups = {
        {"General", {"--output", "--json", "--name", "--quiet", "--help"}},
        {"Plant", {"--plant", "--irradiance", "--ground-area"}},
        {"Animation", {"--frames", "--fps", "--turn", "--ease", "--shutter", "--keep-frames"}},
        {"Points",
         {"--points", "--color", "--exposure", "--gamma", "--palette", "--ground", "--light", "--glow",
          "--card"}},
        {"Target",
         {"--threshold", "--maps", "--similar", "--objective", "--start", "--blocks", "--tolerance"}},
        {"File", {"--limit", "--unit", "--levels", "--nodes", "--part", "--instancing", "--plotter"}},
        {"Picture",
         {"--size", "--engine", "--device", "--quality", "--antialias", "--plain-light", "--bits", "--tile",
          "--transparent", "--watch"}},
        {"Camera", {"--camera", "--at", "--zoom", "--eye"}},
        {"Model", {"--steps", "--set", "--preset", "--seed"}},
        {"Detail and cost", {"--error", "--error-world", "--work", "--memory", "--threads"}},
        {"graftal's engines",
         {"--progressive", "--no-progressive", "--samples", "--noise", "--denoise", "--aovs"}},
        {"POV-Ray", {"--keep", "--visible-only"}},
        {"For experts",
         {"--after", "--root", "--exact", "--flatten", "--unconfined", "--dump-after", "--time"}},
    };
    return groups;
}

class GroupedFormatter : public CLI::Formatter {
  public:
    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
        const HelpFooter footer = help_footer(*app);
        const auto set_off = [](const std::string& text) { return text.empty() ? "" : "\n" + text; };
        return make_description(app) + make_usage(app, std::move(name)) + set_off(footer.examples) +
               make_positionals(app) + make_headed(app) + make_subcommands(app, mode) + set_off(footer.notes);
    }

  private:
    std::string make_headed(const CLI::App* app) const {
        std::string text;
        for (const OptionGroup& group : option_groups()) {
            std::vector<const CLI::Option*> options;
            for (const std::string_view name : group.options)
                if (const CLI::Option* const option = app->get_option_no_throw(std::string(name));
                    option && option->get_group() == group.heading)
                    options.push_back(option);
            if (!options.empty()) text += make_group(group.heading, false, options);
        }
        const auto has_no_heading = [](const CLI::Option* option) {
            return option->nonpositional() && option->get_group() == "Options";
        };
        const std::vector<const CLI::Option*> others = app->get_options(has_no_heading);
        return others.empty() ? text : text + make_group("Options", false, others);
    }
};

} // namespace

bool is_for_tests(const CLI::Option& option) {
    return option.get_name().starts_with("--test-");
}

void group_options(CLI::App& command) {
    for (CLI::Option* const option : command.get_options())
        if (is_for_tests(*option)) option->group("Tests"); // no heading of the help
    for (CLI::App* const action : command.get_subcommands([](const CLI::App*) { return true; }))
        group_options(*action);
    constexpr std::size_t most_in_one_list = 15;
    if (command.get_options().size() <= most_in_one_list) return;
    for (const OptionGroup& group : option_groups())
        for (const std::string_view name : group.options)
            if (CLI::Option* const option = command.get_option_no_throw(std::string(name)))
                option->group(group.heading);
}

HelpFooter help_footer(const CLI::App& command) {
    HelpFooter footer;
    bool in_examples = false;
    for (const std::string& line : CLI::detail::split(command.get_footer(), '\n')) {
        in_examples = in_examples || line.starts_with("Example");
        if (!line.empty()) (in_examples ? footer.examples : footer.notes) += line + "\n";
    }
    return footer;
}

std::shared_ptr<CLI::Formatter> help_formatter() {
    return std::make_shared<GroupedFormatter>();
}

} // namespace graftal
