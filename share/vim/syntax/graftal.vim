" Vim syntax: graftal's models (.lsys, .rifs, .inst)
if exists("b:current_syntax")
  finish
endif

syntax keyword graftalStatement camera light background ground material steps sky haze film object canonical use let rifs map follow terminal condense lsys main axiom ignore angle step width seed interpret decompose modules tropism thickness thinnest vertical table with inner start colors repeat union instance scatter count over except by condense codes orbit texture below
syntax keyword graftalShape sphere cube cylinder cone torus disc square triangle frustum plane superellipsoid polygon bezier_patch sphere_sweep torus mesh leaf
syntax keyword graftalChange scale translate rotate matrix shear reflect tint color rgb hsv
syntax keyword graftalFunction sin cos tan asin acos atan atan2 sqrt exp log floor ceil abs sign min max mod pow lerp smooth logistic random normal
syntax match graftalField "\<[a-z_]\+\ze\s*:"
syntax match graftalNumber "\<\d\+\%(\.\d*\)\=\%([eE][+-]\=\d\+\)\="
syntax match graftalNumber "\.\d\+\%([eE][+-]\=\d\+\)\="
syntax match graftalArrow "--\=>"
syntax match graftalComment "\%(#\|//\).*$"
syntax region graftalComment start="/\*" end="\*/"
syntax region graftalString start=+"+ end=+"+ oneline

highlight default link graftalStatement Statement
highlight default link graftalShape Type
highlight default link graftalChange Keyword
highlight default link graftalFunction Function
highlight default link graftalField Identifier
highlight default link graftalNumber Number
highlight default link graftalArrow Operator
highlight default link graftalComment Comment
highlight default link graftalString String

setlocal commentstring=#\ %s
let b:current_syntax = "graftal"
