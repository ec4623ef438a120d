"""Machine-checked verdicts on the statements of the paper, and on those that exactfold adds.

There is one module for each theorem or family of theorems. Each module has the function
`prove(change=None) -> Proof`, runs alone (`python -m proofs.NAME`), and is listed in
`proofs.MODULES`. `python -m proofs` runs all of them.
"""

MODULES: tuple[str, ...] = (
    "length_equations",
    "curvature_expansion",
    "wheel_stress",
    "force_balance",
    "hub_balance",
    "second_order_motions",
    "vertex_forms",
    "vertex_eigenvalues",
    "mountain_valley",
    "kapovich_millson",
    "all_real",
    "periodic",
    "periodic_directions",
    "generic",
    "exceptions",
    "potential",
    "inertia",
    "inertia_cases",
    "certification",
    "butterfly",
    "h1_doubling",
    "h1_triangulations",
    "eigenvector",
    "vertex_signs",
    "counting",
    "table_counts",
    "discussion_counts",
    "random_squares",
    "branch_angles",
    "branch_counts",
    "multiplicity",
    "panels",
    "matching",
)
