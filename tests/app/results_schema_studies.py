"""Small studies that together write every dataset of docs/results_schema.md; SCENES stands for the folder of scenes."""

STUDIES = {
    # rk4 is fitted; verlet is not applicable to y' = f(t, y); symplectic_euler finds no step that is fine enough
    "convergence": """
kind = "convergence"
title = "Order of accuracy"
methods = ["rk4", "verlet", "symplectic_euler"]

[convergence]
levels = 6
max_steps = 4000
start_error = 0.003

[[problem]]
name = "harmonic_oscillator"

[[problem]]
name = "dahlquist"

[[problem]]
scene = "SCENES/harmonic_oscillator.toml"
label = "scene"
t_end = 1.0
""",
    # with and without a reference, from a scene, methods that cannot run, fail or stay too inaccurate
    "agreement": """
kind = "agreement"
title = "Agreement"
methods = ["rk4", "gsl:*", "explicit_euler", "velocity_verlet"]
without = ["gsl:rk1imp"]

[agreement]
error = 1e-6
most_steps = 64

[[problem]]
name = "harmonic_oscillator"

[[problem]]
name = "dahlquist"

[[problem]]
scene = "SCENES/damped_network.toml"
t_end = 0.1
""",
    # direct, iterative, and one that does not get there
    "linear_solver": """
kind = "linear_solver"
title = "Linear solvers"
solvers = ["cg", "cholmod", "petsc -ksp_type richardson -pc_type none -ksp_max_it 2"]

[linear_solver]
steps = [0.01]
repetitions = 2
sequence = 3

[[problem]]
scene = "SCENES/damped_network.toml"
t_end = 0.1
""",
    # all parts; a linear force, a system without springs, a run that stops
    "jacobian": """
kind = "jacobian"
title = "Derivatives"
seed = 3

[springs]
laws = ["hooke"]
samples = 5

[derivatives]
samples = 2

[definiteness]
compressions = [0.5, 1.2]
steps = [0.001, 0.1, 0.5]

[runs]
methods = ["implicit_euler_linearised"]
compressions = [0.5]
steps = [0.001, 0.1]

[[problem]]
scene = "SCENES/buckling_chain.toml"
t_end = 0.5
""",
    # numbers and strings as parameters
    "sweep": """
kind = "sweep"
title = "Sweep"

[[parameter]]
path = "problem[0].parameters.stiffness"
unit = "N/m"
values = [1, 2.5]

[[parameter]]
path = "methods[0]"
name = "scheme"
values = ["rk4", "heun"]

[study]
kind = "simulate"
methods = ["rk4"]
steps = [0.1]
frames = 2

[[study.problem]]
name = "harmonic_oscillator"
t_end = 1.0
""",
    # constant steps and tolerances, a method that cannot run, and the fronts
    "work_precision": """
kind = "work_precision"
title = "Error against work"
methods = ["rk4", "verlet", "dormand_prince_54"]

[work_precision]
max_evaluations = 500
repetitions = 2
shortest_sample = 1e-5

[[problem]]
name = "dahlquist"

[[problem]]
scene = "SCENES/harmonic_oscillator.toml"
label = "scene"
t_end = 1.0
""",
    # costs, orders and overviews; a method that cannot run
    "stiffness": """
kind = "stiffness"
title = "Stiffness"
methods = ["rk4", "verlet", "implicit_euler"]

[stiffness]
map_levels = 6
repetitions = 2
shortest_sample = 1e-5

[[problem]]
name = "prothero_robinson"
vary = { parameter = "lambda", values = [-1e1, -1e2, -1e3] }
""",
    # with and without a closed form, with and without invariants, with one and with a fixed step, from a scene
    "trajectories": """
kind = "simulate"
title = "Trajectories"
methods = ["explicit_euler", "sundials:cvode_bdf"]
steps = [0.1]
frames = 5

[[problem]]
name = "rotation"
t_end = 1.0

[[problem]]
name = "van_der_pol"
t_end = 0.1

[[problem]]
name = "spring_pendulum"
t_end = 0.1

[[problem]]
scene = "SCENES/damped_network.toml"
t_end = 0.1

[vector_field]
lower = [-1.0, -1.0]
upper = [1.0, 1.0]
counts = [3, 4]
""",
    # with theory, modified energies and neither; free, with dampers; a run that explodes
    "energy": """
kind = "energy"
title = "Energy"
methods = ["velocity_verlet", "explicit_euler"]

[energy]
steps = [0.02, 0.01]
step_count = 300
bins = 10

[[problem]]
name = "harmonic_oscillator"

[[problem]]
name = "henon_heiles"

[[problem]]
scene = "SCENES/free_network.toml"
t_end = 1.0

[[problem]]
scene = "SCENES/damped_network.toml"
t_end = 1.0
""",
    # with and without coefficients
    "dissipation": """
kind = "dissipation"
title = "Damping"
methods = ["implicit_euler", "explicit_euler", "gsl:rk4"]

[dissipation]
count = 4
""",
    "verify": """
kind = "verify"
title = "Verification"
methods = ["rk4", "xpbd"]

[verify]
parts = ["stability_function", "reversibility"]
""",
    # explicit, implicit, without stages to predict from; a scene
    "propagation": """
kind = "propagation"
title = "Propagation"
methods = ["velocity_verlet", "implicit_euler", "adams_bashforth2"]

[propagation]
steps = [0.06]
step_count = 20

[[problem]]
name = "linear_chain"
parameters = { count = 21 }

[[problem]]
scene = "SCENES/resting_cloth.toml"
t_end = 1.0
""",
    "decay": """
kind = "simulate"
title = "One unknown"
methods = ["rk4"]
steps = [0.5]
construction_steps = 2

[[problem]]
name = "dahlquist"
t_end = 1.0

[vector_field]
lower = [0.0, -1.0]
upper = [1.0, 1.0]
counts = [3, 2]
""",
    # regions with and without a root locus, a limit on a scene, a law
    "stability": """
kind = "stability"
title = "Stability"
methods = ["rk4", "adams_bashforth3"]

[regions]
points = 11

[limits]
fewest_steps = 100
farthest = 20.0

[[problem]]
scene = "SCENES/taut_chain.toml"
t_end = 0.1
linearise = true

[[problem]]
name = "dahlquist"
vary = { parameter = "lambda", values = [-1.0, -2.0, -4.0] }
exponent = -1.0
""",
}
