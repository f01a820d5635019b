# L-Parser
9       # recursion
22      # angle
40      # thickness
A
A=F[&'(.7)!A]/////[&'(.7)!A]///////[&'(.7)!A]F'A
@
