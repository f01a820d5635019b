" Vim syntax: graftal's models (.lsys, .rifs, .inst)
if exists("b:current_syntax")
  finish
endif

syntax keyword graftalStatement angle apart array background below bending by camera canonical chance codes colors condense consider contexts control count decompose decomposition difference do each else end environment except film follow ground haze homomorphism hue if ignore ink inner instance interpret intersection lean let light lsys main map material modules nothing object orbit over precedence preset probability repeat rifs scatter seed size skin sky start step steps table taper terminal text texture thickness thinnest torque tropism turn union use variable weights when while width with
syntax keyword graftalShape bicubic_patch cone cube cylinder frustum limb_sweep mesh plane polygon sphere sphere_sweep superellipsoid torus triangle
syntax keyword graftalChange color hsv matrix points projection rgb rotate scale shear tint translate
syntax keyword graftalFunction abs acos asin atan atan2 ceil choose cos exp floor lerp log logistic max min mod normal pow random sign sin smooth sqrt tan
syntax match graftalField "\<[a-z_]\+\ze\s*:"
syntax match graftalNumber "\<\d\+\%(\.\d*\)\=\%([eE][+-]\=\d\+\)\="
syntax match graftalNumber "\.\d\+\%([eE][+-]\=\d\+\)\="
syntax match graftalComment "\%(#\|//\).*$"
syntax region graftalComment start="/\*" end="\*/"
syntax region graftalString start=+"+ end=+"+ oneline

" The strings of L-systems: only # begins a comment, and open brackets hold lines together.
syntax region graftalWord matchgroup=graftalArrow start="-\{1,2}>" start="\<axiom\>:\=" end="$" contains=graftalRemark,graftalBranch,graftalArguments,graftalTurtle
syntax region graftalBranch matchgroup=graftalTurtle start="\[" end="\]" contained contains=graftalRemark,graftalBranch,graftalArguments,graftalTurtle
syntax region graftalArguments start="(" end=")" contained contains=graftalArguments,graftalComment,graftalNumber,graftalFunction
syntax match graftalTurtle "[-+&^/\\|!~;@%$'.{}]" contained
syntax match graftalRemark "#.*$" contained

highlight default link graftalStatement Statement
highlight default link graftalShape Type
highlight default link graftalChange Keyword
highlight default link graftalFunction Function
highlight default link graftalField Identifier
highlight default link graftalNumber Number
highlight default link graftalArrow Operator
highlight default link graftalTurtle Operator
highlight default link graftalRemark Comment
highlight default link graftalComment Comment
highlight default link graftalString String

setlocal commentstring=#\ %s
let b:current_syntax = "graftal"
