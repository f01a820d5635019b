#pragma once

#include "compiler/import/importer.h"

// The rows of the table in importers.cpp: each room defines its own.

namespace graftal {

/// L-systems of cpfg, of the Virtual Laboratory (`.l`), one in each file. The view file of the same name
/// lies beside it (`.v`), and names the functions. Source: the CPFG manual (Prusinkiewicz, Hanan, Mech and
/// others, University of Calgary), and where it is silent, lsys_input.y, generate.c and interpret.c of the
/// program.
Importer cpfg_importer();

/// Fractint's L-systems (`.l`): many in a file, as blocks `Name { Angle 6  Axiom F--F--F  F=F+F--F+F }`,
/// each statement on its own line, in letters of any case (Fractint 20, "L-Systems"). Where the manual is
/// silent, this follows the program: Iterated Dynamics, libid/fractals/lsystem.cpp.
Importer fractint_lsystem_importer();

/// Files of L-Parser (`.ls`), one model in each, in both layouts: depth, angle, thickness, axiom, rules and
/// `@`, each on its line (Lparser 3 and 4); and lines that begin with a keyword (Lparser 5 and Lparser2).
/// Where the manual is silent, what the programs do: Lapre's Lparser2.c, and K-3D's port of Lparser 4.
Importer lparser_importer();

/// `.lpy` files of L-Py (OpenAlea), where they are plain L-systems: rules may decide by `if` and name values,
/// but loops, objects and modules of Python are refused by their line.
Importer lpy_importer();

/// Houdini's L-system node, as people publish its parameters: a text of lines such as `Premise: A` and
/// `Rule 1: A=F[+A]`. Other lines are remarks. Each premise begins a model.
Importer houdini_importer();

/// L-systems as Paul Bourke publishes them ("L-System User Notes", 1991, paulbourke.net/fractals/lsys): a
/// text of lines such as `axiom = F`, `F -> F+F` and `angle = 60`. Other lines are remarks. Each axiom begins
/// a model.
Importer bourke_importer();

/// Surfaces of the Virtual Laboratory (`.s`, by stedit and bezieredit): Bezier patches of four rows of four
/// points, with the point, the heading and the up vector by which cpfg's turtle takes hold of them.
Importer vlab_surface_importer();

/// Fractint's iterated function systems (`.ifs`), of the plane and of space: maps by rows of 6 or 12 numbers
/// and a probability, as in Fractint's manual, "IFS". They become `.rifs`. A system whose maps do not all
/// shrink has no limit set, and becomes an orbit, for `graftal points`.
Importer fractint_ifs_importer();

/// EisenScript (`.es`), the language of Structure Synth 1.5. Rules become objects with parameters: the
/// generations that are left where `maxdepth` or `maxobjects` ends the growth, and the counts of rules with a
/// depth of their own. The middle of the cube lies at the origin.
Importer eisenscript_importer();

/// Context Free's grammars (`.cfdg`), versions 2 and 3. Shapes become objects in the plane, rules with
/// weights become alternatives, colours inks. Smaller shapes lie in front, as Context Free paints them later.
Importer cfdg_importer();

/// Fractal flames (`.flame`, `.flam3`) of flam3, Apophysis and their kin (Draves and Reckase, "The Fractal
/// Flame Algorithm"). Flames whose maps are affine and shrink become `.rifs`, with `chaos` (xaos) as the
/// control digraph. Others become orbits, as far as their variations have formulas.
Importer flame_importer();

} // namespace graftal
