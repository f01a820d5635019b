#include "runtime/export/plant_files.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <unordered_set>
#include <utility>
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

/// A module with the numbers that are found from the whole plant.
struct PlantRow {
    const PlantModule& module;
    unsigned strahler = 0;
    double path = 0;
    const OrganLight* light = nullptr; ///< null: of no row
};

PlantRow row_of(const WrittenPlant& table, std::size_t id) {
    return {table.plant.modules[id], table.tree.strahler[id], table.tree.path[id],
            table.light ? &table.light->organs[id] : nullptr};
}

/// Numbers that every format has, in this order; no number: not known.
struct Column {
    const char* name;
    double (*value)(const PlantRow& row);
};
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
double six_decimals(float number) {
    return std::nearbyint(1e6 * static_cast<double>(number)) / 1e6;
}
constexpr Column columns[] = {
    {"x", [](const PlantRow& row) { return row.module.start.x; }},
    {"y", [](const PlantRow& row) { return row.module.start.y; }},
    {"z", [](const PlantRow& row) { return row.module.start.z; }},
    {"end_x", [](const PlantRow& row) { return row.module.end.x; }},
    {"end_y", [](const PlantRow& row) { return row.module.end.y; }},
    {"end_z", [](const PlantRow& row) { return row.module.end.z; }},
    {"heading_x", [](const PlantRow& row) { return row.module.heading.x; }},
    {"heading_y", [](const PlantRow& row) { return row.module.heading.y; }},
    {"heading_z", [](const PlantRow& row) { return row.module.heading.z; }},
    {"length", [](const PlantRow& row) { return row.module.length; }},
    {"width", [](const PlantRow& row) { return row.module.width; }},
    {"radius", [](const PlantRow& row) { return row.module.width / 2; }},
    {"area", [](const PlantRow& row) { return row.module.is_measured ? row.module.area : unknown; }},
    {"volume", [](const PlantRow& row) { return row.module.is_measured ? row.module.volume : unknown; }},
    {"strahler",
     [](const PlantRow& row) { return row.strahler > 0 ? static_cast<double>(row.strahler) : unknown; }},
    {"path", [](const PlantRow& row) { return row.path; }},
};
/// The light on organs, where it was asked for.
constexpr Column light_columns[] = {
    {"irradiance", [](const PlantRow& row) { return six_decimals(row.light->light); }},
    {"irradiance_error", [](const PlantRow& row) { return six_decimals(row.light->error); }},
    {"absorbed", [](const PlantRow& row) { return six_decimals(row.light->absorbed); }},
    {"sunlit", [](const PlantRow& row) { return six_decimals(row.light->sunlit); }},
};
/// The rest of the turtle's frame, which JSON has too.
constexpr Column frame_columns[] = {
    {"left_x", [](const PlantRow& row) { return row.module.left.x; }},
    {"left_y", [](const PlantRow& row) { return row.module.left.y; }},
    {"left_z", [](const PlantRow& row) { return row.module.left.z; }},
    {"up_x", [](const PlantRow& row) { return row.module.up.x; }},
    {"up_y", [](const PlantRow& row) { return row.module.up.y; }},
    {"up_z", [](const PlantRow& row) { return row.module.up.z; }},
};

/// Columns that the table has in every format.
std::vector<Column> columns_of(const WrittenPlant& table) {
    std::vector<Column> all(std::begin(columns), std::end(columns));
    if (table.light) all.insert(all.end(), std::begin(light_columns), std::end(light_columns));
    return all;
}

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

std::optional<std::string> csv(const WrittenPlant& table, std::uint64_t most_bytes) {
    const Plant& plant = table.plant;
    const std::vector<Column> all = columns_of(table);
    const std::size_t parameters = most_parameters(plant);
    std::string text = "id,name,parent,relation,order,rank,age,part_of,organ,material";
    for (const Column& column : all)
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
        for (const Column& column : all)
            text += "," + cell(column.value(row_of(table, id)));
        for (std::size_t i = 0; i < parameters; ++i)
            text += i < module.parameters.size() ? "," + shortest(module.parameters[i]) : ",";
        text += '\n';
    }
    return text;
}

/// Row by row: a tree of all rows takes ten times the memory of the text.
std::optional<std::string> json(const WrittenPlant& table, std::uint64_t most_bytes) {
    const Plant& plant = table.plant;
    std::vector<Column> all = columns_of(table);
    all.insert(all.end(), std::begin(frame_columns), std::end(frame_columns));
    using Json = nlohmann::ordered_json;
    const auto number = [](double value) { return std::isnan(value) ? Json(nullptr) : Json(value); };
    const auto id = [](std::uint32_t row) { return row == PlantModule::none ? Json(nullptr) : Json(row); };
    const auto word = [](std::string_view name) { return name.empty() ? Json(nullptr) : Json(name); };
    std::string text = fmt::format("{{\n \"steps\": {},\n \"modules\": [", shortest(plant.steps));
    for (std::size_t number_of_row = 0; number_of_row < plant.modules.size(); ++number_of_row) {
        const PlantModule& module = plant.modules[number_of_row];
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
        for (const Column& column : all)
            row[column.name] = number(column.value(row_of(table, number_of_row)));
        text += number_of_row == 0 ? "\n  " : ",\n  ";
        if (text.size() > most_bytes) return std::nullopt;
        text += row.dump(-1, ' ', false, Json::error_handler_t::replace);
    }
    text += "\n ]\n}\n";
    return text;
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

/// The letters of a name. What has none is called by what it is: digits are spelled, and `{` is a polygon.
std::string letters_of(std::string_view name) {
    constexpr std::string_view digits[] = {"Zero", "One", "Two",   "Three", "Four",
                                           "Five", "Six", "Seven", "Eight", "Nine"};
    std::string letters, spelled;
    for (const char c : name) {
        if (std::isalpha(static_cast<unsigned char>(c))) letters += c;
        if (c >= '0' && c <= '9') spelled += digits[c - '0'];
        if (c == '{') spelled += "Polygon";
    }
    if (!letters.empty()) return letters == "P" ? "PPart" : letters; // P is the plant
    return spelled.empty() ? "Part" : spelled;
}

/// Names of classes of vertices, letters only: digits are their indices. "" where no vertex has the name.
/// Nothing where the pairs of them take more than `most_bytes` bytes.
std::optional<std::vector<std::string>> class_names(const Plant& plant, std::uint64_t most_bytes) {
    std::vector<bool> used(plant.names.size());
    for (const PlantModule& module : plant.modules)
        if (is_vertex(module)) used[module.name] = true;
    std::vector<std::string> names;
    std::unordered_set<std::string> taken;
    std::unordered_map<std::string, std::size_t> longer; // by the letters: how much the last of them is
    std::uint64_t bytes = 0;
    for (std::size_t i = 0; i < plant.names.size(); ++i) {
        if (!used[i]) {
            names.emplace_back();
            continue;
        }
        std::string letters = letters_of(plant.names[i]);
        std::size_t& more = longer[letters];
        letters.append(more, 'x');
        for (; !taken.insert(letters).second; ++more)
            letters += 'x';
        bytes += letters.size();
        if (bytes * taken.size() > most_bytes) return std::nullopt;
        names.push_back(letters);
    }
    return names;
}

/// The coding of Godin and Guedon (AMAPmod, FORM-A): one plant P1, whose vertices stand in the column of
/// their order; `^<` follows the last vertex of its column, and `+` branches off that of the column before.
std::optional<std::string> mtg(const WrittenPlant& table, std::uint64_t most_bytes) {
    const Plant& plant = table.plant;
    const std::vector<Column> all = columns_of(table);
    const std::optional<std::vector<std::string>> named = class_names(plant, most_bytes);
    if (!named) return std::nullopt;
    const std::vector<std::string>& classes = *named;
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
    const std::string every = fmt::format("{}", fmt::join(used, ","));
    for (const char* relation : {"<", "+"})
        for (const std::string& name : used) {
            if (text.size() > most_bytes) return std::nullopt;
            text += fmt::format("{}\t{}\t{}\t?\n", name, every, relation);
        }
    text += "\nFEATURES:\nNAME\tTYPE\n";
    std::string features;
    for (const Column& column : all)
        features += fmt::format("\t{}", column.name);
    for (std::size_t i = 0; i < parameters; ++i)
        features += fmt::format("\tp{}", i + 1);
    for (const Column& column : all)
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
        for (const Column& column : all) {
            if (std::exchange(begun, true)) text += '\t';
            text += decimal(column.value(row_of(table, id)));
        }
        for (std::size_t i = 0; i < parameters; ++i)
            text += i < module.parameters.size() ? "\t" + decimal(module.parameters[i]) : "\t";
        text += '\n';
    }
    return text;
}

/// A sentence about the classes whose names are not those of the model; "" if there are none.
std::string renamed_classes(const Plant& plant) {
    constexpr std::size_t most_told = 20;
    const std::vector<std::string> classes = class_names(plant, UINT64_MAX).value();
    std::vector<std::string> told;
    std::size_t renamed = 0;
    for (std::size_t i = 0; i < classes.size(); ++i) {
        if (classes[i].empty() || classes[i] == plant.names[i]) continue;
        if (++renamed <= most_told) told.push_back(fmt::format("{} is '{}'", classes[i], plant.names[i]));
    }
    if (renamed == 0) return "";
    if (renamed > most_told) told.push_back(fmt::format("and {} more", renamed - most_told));
    return fmt::format("the classes of an .mtg have letters only: {}", fmt::join(told, ", "));
}

std::size_t vertices_of(const Plant& plant) {
    return static_cast<std::size_t>(std::ranges::count_if(plant.modules, is_vertex));
}

constexpr PlantFormat formats[] = {
    {".csv", "a table, one row a module", csv},
    {".json", "the same as JSON", json},
    {".mtg", "a multiscale tree graph, as OpenAlea reads it", mtg, vertices_of, renamed_classes},
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

std::string refusal_of_plant_options(const PlantFormat& format, const ExportOptions& options,
                                     bool finds_parts) {
    ExportFormat takes_none;
    takes_none.extension = format.extension;
    if (const ExportWish* const wish = find_vain_wish(takes_none, options))
        return fmt::format("{} is for {}, not for {}", wish->option, endings_with(wish->has),
                           format.extension);
    if (!finds_parts) return "";
    return fmt::format("error, at and zoom are for {}, not for {}, which has all modules", export_endings(),
                       format.extension);
}

std::optional<std::string> export_plant(PictureSession& session, const RenderOptions& render,
                                        const PlantFormat& format, const ExportOptions& options,
                                        const PlantLightOptions* light, Compilation& compilation) {
    const std::shared_ptr<const Plant> plant = plant_of_model(
        session, render.compile,
        fmt::format("only L-systems have modules, which a {} file holds", format.extension), compilation);
    if (!plant) return std::nullopt;
    std::optional<PlantLight> lit;
    if (light) {
        lit = light_of_model(session, render, *plant, *light, compilation);
        if (!lit) return std::nullopt;
    }
    const WrittenPlant table{*plant, tree_of(*plant), lit ? &*lit : nullptr};
    const std::optional<std::string> text = format.text(table, options.most_bytes);
    if (!text || text->size() > options.most_bytes) {
        compilation.diagnostics
            .error(Span(), fmt::format("the file would have more than {} bytes", options.most_bytes))
            .with_hint("allow more with --limit, or use fewer steps");
        return std::nullopt;
    }
    compilation.status = write_text(options.output, *text);
    if (!compilation.status.ok()) return std::nullopt;
    if (format.note)
        if (const std::string note = format.note(*plant); !note.empty())
            compilation.diagnostics.note(Span(), note);
    const std::size_t rows = format.rows ? format.rows(*plant) : plant->modules.size();
    std::string summary = fmt::format("{} modules after {} steps", rows, shortest(plant->steps));
    if (const std::size_t parts = plant->modules.size() - rows; parts > 0)
        summary += fmt::format(", without the {} that are drawn in their place", parts);
    if (lit)
        summary += fmt::format(", the light on {} organs by {} samples each", lit->lit_organs, lit->samples);
    return summary;
}

} // namespace graftal
