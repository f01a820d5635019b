#include "compiler/editing/names/names.h"

#include <algorithm>
#include <utility>

#include "compiler/editing/names/name_table.h"
#include "compiler/lsys/parse/commands.h"
#include "compiler/syntax/lexer.h"

namespace graftal {

namespace {

/// Walks over a tree, and notes the names that it meets.
class Collector {
  public:
    explicit Collector(const Document& document) : document_(document) {
        file_.span = {0, 0, static_cast<std::uint32_t>(document.text().size())};
    }

    std::vector<NamedThing> collect() && {
        if (const LsysFile* tree = document_.lsys()) file(*tree);
        if (const RifsFile* tree = document_.rifs()) file(*tree);
        if (const InstModule* tree = document_.inst()) file(*tree);
        return std::move(names_).settled();
    }

  private:
    /// A name with dots is that of a used model, and of a part in it.
    void use_object(const NameScope& scope, std::string_view name, Span span) {
        const std::size_t dot = name.find('.');
        span.end = span.begin + static_cast<std::uint32_t>(std::min(dot, name.size()));
        names_.use(scope, NameSpace::object, name.substr(0, dot), span);
    }

    /// The place of an expression's own word: spans include the parentheses around.
    Span word(const Expression& expression) const {
        Span span = expression.span;
        const std::string_view text = document_.text(span);
        if (text.starts_with(expression.text))
            return {span.file, span.begin, span.begin + static_cast<std::uint32_t>(expression.text.size())};
        Diagnostics ignored;
        for (const Token& token : lex_range(document_.sources(), span, ignored))
            if (token.kind == TokenKind::name && token.text == expression.text) return token.span;
        return span;
    }

    void expression(const NameScope& scope, const Expression& value) {
        if (value.kind == Expression::Kind::name || value.kind == Expression::Kind::element)
            names_.use(scope, NameSpace::value, value.text, word(value));
        else if (value.kind == Expression::Kind::call)
            names_.use(scope, NameSpace::function, value.text, word(value));
        for (const Expression& operand : value.operands)
            expression(scope, operand);
    }
    void expression(const NameScope& scope, const std::optional<Expression>& value) {
        if (value) expression(scope, *value);
    }
    void expressions(const NameScope& scope, const std::vector<Expression>& values) {
        for (const Expression& value : values)
            expression(scope, value);
    }
    void transforms(const NameScope& scope, const std::vector<TransformLine>& lines) {
        for (const TransformLine& line : lines)
            expressions(scope, line.numbers);
    }

    // Parts that all languages share

    void models(const std::vector<UseStatement>& uses) {
        for (const UseStatement& use : uses)
            names_.define(file_, NameKind::model, use.name, join(use.name.span, use.path_span));
    }

    /// Materials first: instances name those that stand below.
    void statements(NameScope& scope, const std::vector<SceneStatement>& list) {
        for (const SceneStatement& statement : list)
            if (statement.kind == SceneStatement::Kind::material && !statement.name.empty())
                names_.define(scope, NameKind::material, {document_.text(statement.span), statement.span});
        for (const SceneStatement& statement : list)
            fields(scope, statement);
    }

    void fields(NameScope& scope, const SceneStatement& statement) {
        const bool inner = statement.kind == SceneStatement::Kind::inner;
        const bool let = inner || statement.kind == SceneStatement::Kind::let;
        for (const SceneField& field : statement.fields) {
            expressions(scope, field.values);
            if (statement.kind == SceneStatement::Kind::preset)
                names_.use(scope, NameSpace::value, document_.text(field.span), field.span);
            const bool names_material = field.keyword == "material" || field.keyword == "from";
            if (names_material && field.name_span.known())
                names_.use(scope, NameSpace::material, field.name, field.name_span);
            if (!let) continue;
            Span whole = field.span;
            if (!field.values.empty()) whole = join(whole, field.values.back().span);
            names_.define(scope, inner ? NameKind::inner : NameKind::let,
                          {document_.text(field.span), field.span}, whole);
        }
    }

    // `.lsys`

    void file(const LsysFile& tree) { blocks(tree); }

    /// Reads a file of blocks, in either language. A block may name those after it.
    template<typename Tree> void blocks(const Tree& tree) {
        models(tree.uses);
        for (const auto& block : tree.blocks)
            names_.define(file_, NameKind::block, block.name);
        statements(file_, tree.statements);
        for (std::size_t i = 0; i < tree.blocks.size(); ++i) {
            NameScope scope{&file_, span_between(tree.blocks, i)};
            block(scope, tree.blocks[i]);
        }
    }

    /// From the name of a block to that of the next.
    template<typename Blocks> Span span_between(const Blocks& blocks, std::size_t i) const {
        const std::uint32_t end = i + 1 < blocks.size() ? blocks[i + 1].name.span.begin : file_.span.end;
        return {0, blocks[i].name.span.begin, std::max(end, blocks[i].name.span.end)};
    }

    void block(NameScope& scope, const LsysBlock& block) {
        statements(scope, block.lets);
        for (const Name& table : block.tables)
            names_.define(scope, NameKind::table, table);
        for (const LsysVariable& variable : block.variables) {
            expressions(scope, variable.sizes);
            expressions(scope, variable.values);
            names_.define(scope, NameKind::variable, variable.name);
        }
        modules(scope, block);
        settings(scope, block);
        for (const auto* commands : {&block.start, &block.start_each, &block.end_each, &block.end})
            if (*commands) command_list(scope, (*commands)->list);
        if (block.axiom) string(scope, *block.axiom);
        for (const auto* productions : {&block.productions, &block.interpret, &block.decompose})
            for (const LsysProduction& production : *productions)
                rule(scope, production);
    }

    /// The first production of a module says more about it than the list of names.
    void modules(NameScope& scope, const LsysBlock& block) {
        for (const auto* productions : {&block.productions, &block.decompose, &block.interpret})
            for (const LsysProduction& production : *productions)
                names_.define(scope, NameKind::module, symbol(production.predecessor),
                              join(production.span, production.successor.modules.empty()
                                                        ? Span()
                                                        : production.successor.modules.back().span));
        for (const Name& name : block.modules)
            names_.define(scope, NameKind::module, name);
    }

    void settings(const NameScope& scope, const LsysBlock& block) {
        for (const auto* value : {&block.angle, &block.step, &block.width, &block.thickness, &block.thinnest,
                                  &block.taper, &block.skin, &block.seed})
            if (*value) expression(scope, (*value)->value);
        if (block.steps) expression(scope, block.steps->value);
        if (block.filter)
            for (const Name& name : block.filter->symbols)
                names_.use(scope, NameSpace::module, name);
        for (const LsysDirection& tropism : block.tropisms) {
            expressions(scope, tropism.direction);
            expression(scope, tropism.angle);
        }
        for (const LsysEnvironment& environment : block.environment)
            expressions(scope, environment.numbers);
        for (const Name& colour : block.colors)
            names_.use(scope, NameSpace::material, colour);
    }

    Name symbol(const LsysFormal& formal) const { return {formal.symbol, document_.span_of(formal.symbol)}; }

    void string(const NameScope& scope, const LsysString& string) {
        for (const LsysModule& module : string.modules) {
            names_.use(scope, NameSpace::module, module.symbol, document_.span_of(module.symbol));
            if (!module.model.empty()) use_object(scope, module.model, document_.span_of(module.model));
            expressions(scope, module.parameters);
        }
    }

    void rule(const NameScope& outer, const LsysProduction& production) {
        Span span = production.span;
        if (!production.successor.modules.empty())
            span = join(span, production.successor.modules.back().span);
        if (production.probability) span = join(span, production.probability->span);
        NameScope scope{&outer, span};
        if (!production.label.text.empty()) names_.define(scope, NameKind::label, production.label);
        for (const auto* formals : {&production.left, &production.following, &production.right})
            for (const LsysFormal& formal : *formals)
                names_.use(outer, NameSpace::module, symbol(formal));
        parameters(scope, production.predecessor);
        for (const auto* formals : {&production.left, &production.following, &production.right})
            for (const LsysFormal& formal : *formals)
                parameters(scope, formal);
        for (const auto& [name, value] : production.locals) {
            expression(scope, value);
            names_.define(scope, NameKind::local, name);
        }
        for (const auto* commands : {&production.before, &production.after})
            if (*commands) {
                define_assigned(scope, (*commands)->list);
                command_list(scope, (*commands)->list);
            }
        expression(scope, production.condition);
        string(scope, production.successor);
        expression(scope, production.probability);
    }

    void parameters(NameScope& scope, const LsysFormal& formal) {
        for (const Name& name : formal.parameters)
            names_.define(scope, NameKind::parameter, name);
    }

    /// Names that a block of a production assigns are its own, except variables.
    void define_assigned(NameScope& scope, const std::vector<LsysCommand>& commands) {
        for_each_assignment(commands, [&](const LsysCommand& command) {
            if (scope.things.contains(std::pair{NameSpace::value, std::string(command.target)}) ||
                names_.is_variable(*scope.outer, command.target))
                return;
            const Span span = target(command);
            names_.define(scope, NameKind::local, {document_.text(span), span});
        });
    }

    static Span target(const LsysCommand& command) {
        return {0, command.span.begin,
                command.span.begin + static_cast<std::uint32_t>(command.target.size())};
    }

    void command_list(const NameScope& scope, const std::vector<LsysCommand>& commands) {
        for_each_assignment(commands, [&](const LsysCommand& command) {
            names_.use(scope, NameSpace::value, command.target, target(command));
        });
        for_each_expression(commands, [&](const Expression& value) { expression(scope, value); });
    }

    // `.rifs`

    void file(const RifsFile& tree) {
        blocks(tree);
        for (std::size_t i = 0; i < tree.orbits.size(); ++i) {
            names_.define(file_, NameKind::block, tree.orbits[i].name);
            NameScope scope{&file_, span_between(tree.orbits, i)};
            orbit(scope, tree.orbits[i]);
        }
    }

    void look(const NameScope& scope, const RifsLook& look) {
        expressions(scope, look.tint);
        if (look.material) names_.use(scope, NameSpace::material, *look.material);
    }

    void part(const NameScope& scope, const RifsPart& part) {
        use_object(scope, part.master.text, part.master.span);
        expressions(scope, part.arguments);
        transforms(scope, part.transforms);
        look(scope, part.look);
        expression(scope, part.probability);
        expression(scope, part.below);
    }

    void block(NameScope& scope, const RifsBlock& block) {
        for (const RifsMap& map : block.maps)
            if (!map.name.text.empty()) {
                names_.define(scope, NameKind::map, map.name, map.span);
            } else { // known by its number only
                names_.define_nameless(scope, NameKind::map, "w" + std::to_string(map.number), map.span);
            }
        for (const RifsMap& map : block.maps) {
            transforms(scope, map.transforms);
            expressions(scope, map.codes);
            expression(scope, map.probability);
            look(scope, map.look);
            if (map.from) names_.use(scope, NameSpace::object, *map.from);
            if (map.terminal) part(scope, *map.terminal);
        }
        if (block.follow) {
            for (const RifsEdge& edge : block.follow->edges) {
                names_.use(scope, NameSpace::map, edge.from);
                names_.use(scope, NameSpace::map, edge.to);
            }
            expressions(scope, block.follow->expressions);
        }
        for (const Name& name : block.start)
            names_.use(scope, NameSpace::map, name);
        for (const RifsPart& condensation : block.condense)
            part(scope, condensation);
        if (block.terminal) part(scope, *block.terminal);
    }

    void orbit(NameScope& scope, const OrbitBlock& orbit) {
        const auto lets = [this](NameScope& into, const std::vector<OrbitLet>& list, NameKind kind) {
            for (const OrbitLet& let : list) {
                expression(into, let.value);
                names_.define(into, kind, let.name, join(let.name.span, let.value.span));
            }
        };
        lets(scope, orbit.lets, NameKind::let);
        for (const OrbitFunction& function : orbit.functions) {
            NameScope inside{&scope, join(function.name.span, function.body.span)};
            for (const Name& parameter : function.parameters)
                names_.define(inside, NameKind::parameter, parameter);
            expression(inside, function.body);
            names_.define(scope, NameKind::function, function.name, inside.span);
        }
        for (const OrbitMap& map : orbit.maps) {
            NameScope inside{&scope, map.span};
            if (!map.name.text.empty()) names_.define(scope, NameKind::map, map.name, map.span);
            lets(inside, map.lets, NameKind::local);
            for (const std::optional<Expression>& coordinate : map.coordinates)
                expression(inside, coordinate);
            expression(inside, map.probability);
            look(inside, map.look);
        }
        expressions(scope, orbit.start);
        expression(scope, orbit.skip);
        expression(scope, orbit.restart);
    }

    // `.inst`

    void file(const InstModule& tree) {
        models(tree.uses);
        for (const InstDefinition& definition : tree.definitions) {
            Span name = definition.span;
            name.end = name.begin + static_cast<std::uint32_t>(definition.name.size());
            names_.define(file_, NameKind::object, {document_.text(name), name}, definition.span);
        }
        statements(file_, tree.scene);
        for (std::size_t i = 0; i < tree.definitions.size(); ++i) {
            const InstDefinition& definition = tree.definitions[i];
            const std::uint32_t end =
                i + 1 < tree.definitions.size() ? tree.definitions[i + 1].span.begin : tree.end.end;
            NameScope scope{&file_, {0, definition.span.begin, std::max(end, definition.span.end)}};
            object(scope, definition);
        }
    }

    void object(NameScope& scope, const InstDefinition& definition) {
        for (const InstParameter& parameter : definition.parameters)
            if (!parameter.is_number())
                names_.define(scope, NameKind::parameter, {document_.text(parameter.span), parameter.span});
        expression(scope, definition.weight);
        for (const auto& test : definition.tests)
            expression(scope, test->test);
        for (const InstGroup& group : definition.groups)
            placed(scope, group);
    }

    void placed(const NameScope& scope, const InstGroup& group) {
        for (const InstReference& master : group.masters) {
            use_object(scope, master.name, master.span);
            expressions(scope, master.arguments);
        }
        transforms(scope, group.transforms);
        colours(scope, group.tints, group.ink);
        if (group.material) names_.use(scope, NameSpace::material, *group.material, group.material_span);
        expression(scope, group.below);
        expression(scope, group.chance);
        if (group.hue) expression(scope, *group.hue);
        if (group.scatter) scattered(scope, *group.scatter);
        for (const auto& repeat : group.repeats) {
            expression(scope, repeat->count);
            transforms(scope, repeat->transforms);
            colours(scope, repeat->tints, repeat->ink);
            expression(scope, repeat->hue);
        }
    }

    void colours(const NameScope& scope, const std::vector<InstTint>& tints,
                 const std::vector<InstInkStep>& ink) {
        for (const InstTint& tint : tints) {
            expressions(scope, tint.values);
            expressions(scope, tint.until);
        }
        for (const InstInkStep& step : ink)
            expressions(scope, step.values);
    }

    void scattered(const NameScope& scope, const InstScatter& scatter) {
        for (const auto* value : {&scatter.count, &scatter.apart, &scatter.seed})
            expression(scope, *value);
        if (scatter.over) expressions(scope, scatter.over->numbers);
        for (const AreaText& area : scatter.except)
            expressions(scope, area.numbers);
        for (const auto* range : {&scatter.turn, &scatter.lean, &scatter.size})
            if (*range) {
                expression(scope, (*range)->from);
                expression(scope, (*range)->to);
            }
        expressions(scope, scatter.weights);
    }

    const Document& document_;
    NameScope file_;
    NameTable names_;
};

} // namespace

std::string_view word_of(NameKind kind) {
    constexpr std::string_view words[] = {"let",         "inner parameter", "parameter",  "variable", "table",
                                          "local value", "module",          "label",      "material", "map",
                                          "block",       "object",          "used model", "function"};
    return words[static_cast<std::size_t>(kind)];
}

std::vector<NamedThing> names_of(const Document& document) {
    return Collector(document).collect();
}

const NamedThing* thing_at(const std::vector<NamedThing>& things, std::uint32_t offset) {
    const NamedThing* before = nullptr;
    for (const NamedThing& thing : things)
        for (const auto* places : {&thing.definitions, &thing.uses})
            for (const Span place : *places) {
                if (place.begin <= offset && offset < place.end) return &thing;
                if (place.end == offset) before = &thing;
            }
    return before;
}

} // namespace graftal
