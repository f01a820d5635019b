#include "runtime/export/plant_files.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "compiler/support/number.h"

namespace graftal {

namespace {

std::size_t most_parameters(const Plant& plant) {
    std::size_t most = 0;
    for (const PlantModule& module : plant.modules)
        most = std::max(most, module.parameters.size());
    return most;
}

/// Numbers that every format has, in this order.
struct Column {
    const char* name;
    double (*value)(const PlantModule& module);
};
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
    {"length", [](const PlantModule& m) { return glm::length(m.end - m.start); }},
    {"width", [](const PlantModule& m) { return m.width; }},
};

/// Names may hold commas: `,` is a symbol of the turtle.
std::string quoted(const std::string& name) {
    if (name.find_first_of(",\"\n") == std::string::npos) return name;
    std::string text = "\"";
    for (const char c : name)
        text += c == '"' ? "\"\"" : std::string(1, c);
    return text + "\"";
}

std::string csv(const Plant& plant) {
    const std::size_t parameters = most_parameters(plant);
    std::string text = "id,name,parent,relation,order,rank,age";
    for (const Column& column : columns)
        text += fmt::format(",{}", column.name);
    for (std::size_t i = 0; i < parameters; ++i)
        text += fmt::format(",p{}", i + 1);
    text += '\n';
    for (std::size_t id = 0; id < plant.modules.size(); ++id) {
        const PlantModule& module = plant.modules[id];
        const bool first = module.parent == PlantModule::none;
        text += fmt::format("{},{},{},{},{},{},{}", id, quoted(plant.names[module.name]),
                            first ? "" : fmt::format("{}", module.parent),
                            first             ? ""
                            : module.branches ? "branch"
                                              : "axis",
                            module.order, module.rank, module.age < 0 ? "" : fmt::format("{}", module.age));
        for (const Column& column : columns)
            text += "," + shortest(column.value(module));
        for (std::size_t i = 0; i < parameters; ++i)
            text += i < module.parameters.size() ? "," + shortest(module.parameters[i]) : ",";
        text += '\n';
    }
    return text;
}

std::string json(const Plant& plant) {
    using Json = nlohmann::ordered_json;
    Json rows = Json::array();
    for (const PlantModule& module : plant.modules) {
        const bool first = module.parent == PlantModule::none;
        Json row = {{"name", plant.names[module.name]},
                    {"parameters", module.parameters},
                    {"parent", first ? Json(nullptr) : Json(module.parent)},
                    {"relation", first ? Json(nullptr) : Json(module.branches ? "branch" : "axis")},
                    {"order", module.order},
                    {"rank", module.rank},
                    {"age", module.age < 0 ? Json(nullptr) : Json(module.age)}};
        for (const Column& column : columns)
            row[column.name] = column.value(module);
        rows.push_back(std::move(row));
    }
    const Json whole = {{"steps", plant.steps}, {"modules", std::move(rows)}};
    return whole.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// Names of classes of vertices are letters only: digits are their indices.
std::vector<std::string> class_names(const Plant& plant) {
    std::vector<std::string> names;
    for (const std::string& name : plant.names) {
        std::string letters;
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
std::string mtg(const Plant& plant) {
    const std::vector<std::string> classes = class_names(plant);
    const std::size_t parameters = most_parameters(plant);
    std::uint32_t orders = 0;
    for (const PlantModule& module : plant.modules)
        orders = std::max(orders, module.order);
    std::string text = "CODE:\tFORM-A\n\nCLASSES:\nSYMBOL\tSCALE\tDECOMPOSITION\tINDEXATION\tDEFINITION\n"
                       "$\t0\tFREE\tFREE\tIMPLICIT\nP\t1\tFREE\tFREE\tEXPLICIT\n";
    for (const std::string& name : classes)
        text += name + "\t2\tFREE\tFREE\tEXPLICIT\n";
    text += "\nDESCRIPTION:\nLEFT\tRIGHT\tRELTYPE\tMAX\n";
    for (const char* relation : {"<", "+"})
        for (const std::string& name : classes)
            text += fmt::format("{}\t{}\t{}\t?\n", name, fmt::join(classes, ","), relation);
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
        const PlantModule& module = plant.modules[id];
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
            text += shortest(column.value(module));
        }
        for (std::size_t i = 0; i < parameters; ++i)
            text += i < module.parameters.size() ? "\t" + shortest(module.parameters[i]) : "\t";
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

} // namespace graftal
