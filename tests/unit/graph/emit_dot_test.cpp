#include "compiler/graph/text/emit_dot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace graftal {
namespace {

using testing::HasSubstr;
using testing::Not;

Instance edge_to(ObjectId master) {
    Instance instance;
    instance.master = master;
    return instance;
}

TEST(EmitDot, NodesEdgesAndClusters) {
    Graph graph;
    const ObjectId sphere = graph.primitive(PrimitiveKind::sphere);
    Object root, a, b;
    root.name = "root";
    a.name = "leaf.a";
    b.name = "b(2, 0.5)";
    graph.root = graph.add(root);
    const ObjectId a_id = graph.add(a), b_id = graph.add(b);
    graph.objects[graph.root].instances = {edge_to(a_id), edge_to(sphere), edge_to(a_id)};
    graph.objects[a_id].instances = {edge_to(b_id)};
    graph.objects[b_id].instances = {edge_to(a_id), edge_to(a_id), edge_to(a_id)};
    graph.objects[b_id].terminal = edge_to(sphere);
    EXPECT_EQ(emit_dot(graph, strong_components(graph)), "digraph graftal {\n"
                                                         "  rankdir=TB;\n"
                                                         "  node [fontname=\"Helvetica\", shape=ellipse];\n"
                                                         "  edge [fontname=\"Helvetica\"];\n"
                                                         "  subgraph cluster_1 {\n"
                                                         "    style=rounded;\n"
                                                         "    n2 [label=\"leaf.a\"];\n"
                                                         "    n3 [label=\"b(2, 0.5)\"];\n"
                                                         "  }\n"
                                                         "  n0 [label=\"sphere\", shape=box];\n"
                                                         "  n1 [label=\"root\", peripheries=2];\n"
                                                         "  n1 -> n2 [label=\"2\"];\n"
                                                         "  n1 -> n0;\n"
                                                         "  n2 -> n3;\n"
                                                         "  n3 -> n2 [label=\"3\"];\n"
                                                         "  n3 -> n0 [style=dashed, label=\"terminal\"];\n"
                                                         "}\n");
}

TEST(EmitDot, NamesCannotBecomeDot) {
    Graph graph;
    Object evil;
    evil.name = "x\"];\nevil [label=\"\\";
    evil.instances = {edge_to(0)};
    graph.add(evil);
    const std::string text = emit_dot(graph, strong_components(graph));
    EXPECT_THAT(text, HasSubstr("[label=\"x\\\"];?evil [label=\\\"\\\\\", peripheries=2];\n"));
}

TEST(EmitDot, ASelfInstanceIsACluster) {
    Graph graph;
    Object loop;
    loop.name = "loop";
    loop.instances = {edge_to(0)};
    graph.add(loop);
    EXPECT_THAT(emit_dot(graph, strong_components(graph)), HasSubstr("subgraph cluster_0 {"));
    graph.objects[0].instances[0].master = graph.primitive(PrimitiveKind::cube);
    EXPECT_THAT(emit_dot(graph, strong_components(graph)), Not(HasSubstr("cluster")));
}

} // namespace
} // namespace graftal
