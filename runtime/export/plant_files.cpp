#include "runtime/export/plant_files.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "compiler/support/number.h"
#include "runtime/system/file.h"

namespace graftal {

namespace {

std::size_t most_parameters(const Plant& plant) {
    std::size_t most = 0;
    for (const PlantModule& module : plant.modules)
        most = std::max(most, module.parameters.size());
    return most;
}

/// Numbers that every format has, in this order; no number: not known.
struct Column {
    const char* name;
    double (*value)(const PlantModule& module);
};
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr Column columns[] = {
    {"x", [](const PlantModule& m) { return m.start.x; }},
    {"y", [](const PlantModule& m) { return m.start.y; }},
    {"z", [](const PlantModule& m) { return m.start.z; }},
    {"end_x", [](const PlantModule& m) { return m.end.x; }},
    {"end_y", [](const PlantModule& m) { return m.end.y; }},
    {"end_z", [](const PlantModule& m) { return m.end.z; }},
    {"heading_x", [](const PlantModule& m) { return m.heading.x; }},
    {"heading_y", [](const PlantModule& m) { return m.heading.y; }},
    {"heading_z", [](const PlantModule& m) { return m.heading.z; }},
    {"length", [](const PlantModule& m) { return m.length; }},
    {"width", [](const PlantModule& m) { return m.width; }},
    {"radius", [](const PlantModule& m) { return m.width / 2; }},
    {"area", [](const PlantModule& m) { return m.is_measured ? m.area : unknown; }},
    {"volume", [](const PlantModule& m) { return m.is_measured ? m.volume : unknown; }},
};
/// The rest of the turtle's frame, which JSON has too.
constexpr Column frame_columns[] = {
    {"left_x", [](const PlantModule& m) { return m.left.x; }},
    {"left_y", [](const PlantModule& m) { return m.left.y; }},
    {"left_z", [](const PlantModule& m) { return m.left.z; }},
    {"up_x", [](const PlantModule& m) { return m.up.x; }},
    {"up_y", [](const PlantModule& m) { return m.up.y; }},
    {"up_z", [](const PlantModule& m) { return m.up.z; }},
};

std::string_view material_of(const PlantModule& module, const Plant& plant) {
    return module.material == PlantModule::no_name ? std::string_view() : plant.materials[module.material];
}

/// A number, or nothing.
std::string cell(double number) {
    return std::isnan(number) ? "" : shortest(number);
}

std::string cell(std::uint32_t id) {
    return id == PlantModule::none ? "" : fmt::format("{}", id);
}

/// Names may hold commas: `,` is a symbol of the turtle.
std::string csv_name(std::string_view name) {
    if (name.find_first_of(",\"\n") == std::string_view::npos) return std::string(name);
    std::string text = "\"";
    for (const char c : name)
        text += c == '"' ? "\"\"" : std::string(1, c);
    return text + "\"";
}

std::optional<std::string> csv(const Plant& plant, std::uint64_t most_bytes) {
    const std::size_t parameters = most_parameters(plant);
    std::string text = "id,name,parent,relation,order,rank,age,part_of,organ,material";
    for (const Column& column : columns)
        text += fmt::format(",{}", column.name);
    for (std::size_t i = 0; i < parameters; ++i)
        text += fmt::format(",p{}", i + 1);
    text += '\n';
    for (std::size_t id = 0; id < plant.modules.size(); ++id) {
        if (text.size() > most_bytes) return std::nullopt;
        const PlantModule& module = plant.modules[id];
        const bool first = module.parent == PlantModule::none;
        text += fmt::format(
            "{},{},{},{},{},{},{},{},{},{}", id, csv_name(plant.names[module.name]), cell(module.parent),
            first             ? ""
            : module.branches ? "branch"
                              : "axis",
            module.order, module.rank, cell(module.age < 0 ? unknown : module.age), cell(module.part_of),
            name_of(module.organ), csv_name(material_of(module, plant)));
        for (const Column& column : columns)
            text += "," + cell(column.value(module));
        for (std::size_t i = 0; i < parameters; ++i)
            text += i < module.parameters.size() ? "," + shortest(module.parameters[i]) : ",";
        text += '\n';
    }
    return text;
}

/// Row by row: a tree of all rows takes ten times the memory of the text.
std::optional<std::string> json(const Plant& plant, std::uint64_t most_bytes) {
    using Json = nlohmann::ordered_json;
    const auto number = [](double value) { return std::isnan(value) ? Json(nullptr) : Json(value); };
    const auto id = [](std::uint32_t row) { return row == PlantModule::none ? Json(nullptr) : Json(row); };
    const auto word = [](std::string_view name) { return name.empty() ? Json(nullptr) : Json(name); };
    std::string text = fmt::format("{{\n \"steps\": {},\n \"modules\": [", shortest(plant.steps));
    for (const PlantModule& module : plant.modules) {
        const bool first = module.parent == PlantModule::none;
        Json row = {{"name", plant.names[module.name]},
                    {"parameters", module.parameters},
                    {"parent", id(module.parent)},
                    {"relation", first ? Json(nullptr) : Json(module.branches ? "branch" : "axis")},
                    {"order", module.order},
                    {"rank", module.rank},
                    {"age", number(module.age < 0 ? unknown : module.age)},
                    {"part_of", id(module.part_of)},
                    {"organ", word(name_of(module.organ))},
                    {"material", word(material_of(module, plant))}};
        for (const std::span<const Column> some : {std::span<const Column>(columns), {frame_columns}})
            for (const Column& column : some)
                row[column.name] = number(column.value(module));
        text += &module == plant.modules.data() ? "\n  " : ",\n  ";
        if (text.size() > most_bytes) return std::nullopt;
        text += row.dump(-1, ' ', false, Json::error_handler_t::replace);
    }
    return text + "\n ]\n}\n";
}

/// Modules of the word are vertices; their numbers are sums over what is drawn in their place.
bool is_vertex(const PlantModule& module) {
    return module.part_of == PlantModule::none;
}

/// A number without an exponent, since `+` and `-` are signs of the code; nothing for none.
std::string decimal(double number) {
    if (std::isnan(number)) return "";
    char digits[1100]; // the longest double has some 1,080
    const auto end =
        std::to_chars(std::begin(digits), std::end(digits), number, std::chars_format::fixed).ptr;
    return {digits, end};
}

/// Names of classes of vertices, letters only: digits are their indices. "" where no vertex has the name.
std::vector<std::string> class_names(const Plant& plant) {
    std::vector<bool> used(plant.names.size());
    for (const PlantModule& module : plant.modules)
        if (is_vertex(module)) used[module.name] = true;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < plant.names.size(); ++i) {
        const std::string& name = plant.names[i];
        std::string letters;
        if (!used[i]) {
            names.emplace_back();
            continue;
        }
        for (const char c : name)
            if (std::isalpha(static_cast<unsigned char>(c))) letters += c;
        if (letters.empty() || letters == "P") letters += "Part";
        while (std::ranges::find(names, letters) != names.end())
            letters += 'x';
        names.push_back(letters);
    }
    return names;
}

/// The coding of Godin and Guedon (AMAPmod, FORM-A): one plant P1, whose vertices stand in the column of
/// their order; `^<` follows the last vertex of its column, and `+` branches off that of the column before.
std::optional<std::string> mtg(const Plant& plant, std::uint64_t most_bytes) {
    const std::vector<std::string> classes = class_names(plant);
    std::vector<std::string> used = classes;
    std::erase(used, "");
    const std::size_t parameters = most_parameters(plant);
    std::uint32_t orders = 0;
    for (const PlantModule& module : plant.modules)
        orders = std::max(orders, module.order);
    std::string text = "CODE:\tFORM-A\n\nCLASSES:\nSYMBOL\tSCALE\tDECOMPOSITION\tINDEXATION\tDEFINITION\n"
                       "$\t0\tFREE\tFREE\tIMPLICIT\nP\t1\tFREE\tFREE\tEXPLICIT\n";
    for (const std::string& name : used)
        text += name + "\t2\tFREE\tFREE\tEXPLICIT\n";
    text += "\nDESCRIPTION:\nLEFT\tRIGHT\tRELTYPE\tMAX\n";
    for (const char* relation : {"<", "+"})
        for (const std::string& name : used)
            text += fmt::format("{}\t{}\t{}\t?\n", name, fmt::join(used, ","), relation);
    text += "\nFEATURES:\nNAME\tTYPE\n";
    std::string features;
    for (const Column& column : columns)
        features += fmt::format("\t{}", column.name);
    for (std::size_t i = 0; i < parameters; ++i)
        features += fmt::format("\tp{}", i + 1);
    for (const Column& column : columns)
        text += fmt::format("{}\tREAL\n", column.name);
    for (std::size_t i = 0; i < parameters; ++i)
        text += fmt::format("p{}\tREAL\n", i + 1);
    text += "\nMTG:\nENTITY-CODE" + std::string(orders + 1, '\t') + features.substr(1) + "\n";
    bool first = true;
    for (std::size_t id = 0; id < plant.modules.size(); ++id) {
        if (text.size() > most_bytes) return std::nullopt;
        const PlantModule& module = plant.modules[id];
        if (!is_vertex(module)) continue;
        const std::string entity = fmt::format("{}{}", classes[module.name], id + 1);
        const bool root = module.parent == PlantModule::none;
        text += std::string(module.order, '\t');
        if (root)
            text += first ? "/P1/" + entity : "^/" + entity;
        else
            text += (module.branches ? "+" : "^<") + entity;
        first = false;
        text += std::string(orders + 1 - module.order, '\t');
        bool begun = false;
        for (const Column& column : columns) {
            if (std::exchange(begun, true)) text += '\t';
            text += decimal(column.value(module));
        }
        for (std::size_t i = 0; i < parameters; ++i)
            text += i < module.parameters.size() ? "\t" + decimal(module.parameters[i]) : "\t";
        text += '\n';
    }
    return text;
}

constexpr PlantFormat formats[] = {
    {".csv", "a table, one row a module", csv},
    {".json", "the same as JSON", json},
    {".mtg", "a multiscale tree graph, as OpenAlea reads it", mtg},
};

} // namespace

const PlantFormat* find_plant_format(std::string_view path) {
    const auto found = std::ranges::find_if(
        formats, [&](const PlantFormat& format) { return path.ends_with(format.extension); });
    return found == std::end(formats) ? nullptr : found;
}

std::string plant_endings() {
    return fmt::format("{}, {} or {}", formats[0].extension, formats[1].extension, formats[2].extension);
}

std::string vain_plant_wish(const PlantFormat& format, const ExportOptions& options, bool finds_parts) {
    ExportFormat takes_none;
    takes_none.extension = format.extension;
    if (const ExportWish* const wish = find_vain_wish(takes_none, options))
        return fmt::format("{} is for {}, not for {}", wish->option, endings_with(wish->has),
                           format.extension);
    if (!finds_parts) return "";
    return fmt::format("error, at and zoom are for {}, not for {}, which has all modules", export_endings(),
                       format.extension);
}

std::optional<std::string> export_plant(Session& session, StageOptions stages, const PlantFormat& format,
                                        const ExportOptions& options, Compilation& compilation) {
    stages.lower.in_place = LowerOptions::InPlace::plant;
    stages.lower.may_be_orbit = true;
    const std::shared_ptr<const LoweredModel> lowered = session.lowered(stages, compilation);
    if (!lowered || !compilation.status.ok() || compilation.diagnostics.has_errors()) return std::nullopt;
    if (!lowered->notes.plant) {
        compilation.diagnostics.error(
            Span(), fmt::format("only L-systems have modules, which a {} file holds", format.extension));
        return std::nullopt;
    }
    const Plant& plant = *lowered->notes.plant;
    const std::optional<std::string> text = format.text(plant, options.most_bytes);
    if (!text || text->size() > options.most_bytes) {
        compilation.diagnostics
            .error(Span(), fmt::format("the file would have more than {} bytes", options.most_bytes))
            .with_hint("allow more with --limit, or use fewer steps");
        return std::nullopt;
    }
    compilation.status = write_text(options.output, *text);
    if (!compilation.status.ok()) return std::nullopt;
    return fmt::format("{} modules after {} steps", plant.modules.size(), shortest(plant.steps));
}

} // namespace graftal
