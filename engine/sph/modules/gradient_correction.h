/* What gradient_correction.c declares. */

INPUT_SWITCH(method, gradient_correction, 0,
             .doc = "Velocity gradients exact for linear fields, and forces conjugate to them: a body turns without "
                    "strain and keeps its angular momentum, and its free sides are as stiff as its inside. For ringing "
                    "and spinning bodies; costs a quarter more time.",
             .source = "Randles & Libersky 1996; Bonet & Lok 1999; off in BA95")

COLUMN(correction[6]) /* B, at the last pair loop */
