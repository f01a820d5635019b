// EisenScript
set maxdepth 200
8 * { rz 45 hue 20 } 6 * { ry 60 } r
rule r { { x 0.9 rz 6 ry 6 s 0.985 sat 0.99 } r  { s 0.9 0.5 0.2 } sphere }
rule r { { x 0.9 rz -6 ry 6 s 0.985 } r  { s 0.5 0.9 0.3 } box }
