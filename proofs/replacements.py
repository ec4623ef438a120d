r"""Corrected texts for passages of the paper: pairs of LaTeX, by the key of the statement.

The first text of a pair stands once in the source of the paper. `docs/read_paper.py` replaces it by
the second. The formulas in the second text are those of the correction, which a step evaluates; the
tests compare them.
"""

from __future__ import annotations

REPLACEMENTS: dict[str, tuple[tuple[str, str], ...]] = {
    "IIA.6": (
        ("rows indexed by the unique folds $(n,m)$", "rows indexed by the unique edges $(n,m)$"),
        ("a stress vector with one component per fold", "a stress vector with one per edge"),
        (
            r"along the fold $(n,m)$ and the sum is taken over all folds in the network",
            r"along the edge $(n,m)$ and the sum is taken over all edges in the network",
        ),
    ),
    "IIA.12": (
        (
            "the displacements allowed here can only change the stretching energy to at most "
            "sixth-order",
            "the displacements allowed here, with the in-plane displacements that belong to them, "
            "change the stretching energy at eighth order only",
        ),
    ),
    "IIB.21": (
        (
            "exactly one of which is negative (Ref.",
            r"exactly one of which is positive (negative with the opposite sign of $\bm{\sigma}$, "
            r"as from here on and in Appendix \ref{app:quadratic}; Ref.",
        ),
    ),
    "IIB.25": (
        (
            "This eigenvector gives a set of displacements that maximizes the change in the "
            "Gaussian curvature.",
            "Among displacements of a given norm this eigenvector gives those that maximize the "
            "Gaussian curvature (others can change it by more, to negative values).",
        ),
    ),
    "IIB.27": (
        (
            "the component of largest magnitude in this eigenvector is the displacement at the "
            "vertex itself and the neighboring vertices are moved by smaller amounts in the "
            "opposite direction",
            r"the displacement at the vertex itself exceeds that at each neighboring vertex, "
            r"$h_0>h_n$, where $\mathbf{h}_-$ pops up; if the link polygon has no reflex corner, "
            r"the neighboring vertices are moved by smaller amounts in the opposite direction, "
            r"$h_n<0$ and $|h_n|<h_0$",
        ),
    ),
    "IIB.28": (
        (
            r"lies completely in an open hemisphere \cite{streinuwhiteley}",
            r"lies completely in an open hemisphere, or in a closed one if the vertex is folded "
            r"along a straight line only \cite{streinuwhiteley}",
        ),
    ),
    "IIC.5": (
        (
            "single-vertex origami structures have a single branch.",
            "single-vertex origami structures with five or more folds have a single branch; with "
            "four folds they have two, and with three folds none.",
        ),
    ),
    "IIC.8": (
        (
            "planar projections (Schlegel diagrams) of triangulations of spheres",
            "planar projections of triangulations of spheres (Schlegel diagrams if and only if "
            "they have a convex lifting)",
        ),
    ),
    "IIC.10": (
        (
            "Let $B$ be the number of connected components",
            "Let $B$ be the number of irreducible components",
        ),
        (
            "Roughly speaking each of these connected components",
            "Roughly speaking each of these irreducible components",
        ),
    ),
    "IIC.13": (
        (
            "This should be true generically, and in all of the numerical examples considered in "
            "this paper this is indeed the case.",
            "For a convex border they do so along a branch if and only if no vertex star is flat "
            "on it; for any border they do so nowhere where the crease pattern contains a "
            "triangulated triangle.",
        ),
    ),
    "IIC.15": (("(singular when $D>1$)", "(singular unless the cone is a linear space)"),),
    "IIIA.3": (("$3 (V_i-V_t+ 1)$", "$3(V_i-V_t)+1$"),),
    "IIIA.4": (("$2^{3 (V_i-V_t+1)}/2$", "$2^{3(V_i-V_t)+1}/2$"),),
    "IIIA.5": (
        ("$(1/4)^{V_i-V_t-1}$", "$(1/4)^{V_i-V_t}$"),
        (
            ", so this is certainly an overestimate",
            ", and branches may share an assignment, so this may be an overestimate",
        ),
    ),
    "IIIA.8": (
        (
            "we found an increasing number of crease patterns where",
            "we found an increasing fraction of crease patterns where",
        ),
    ),
    "IIIA.12": (
        (
            "with the (conjectural) formula\n\\begin{equation}\nB_{distinct}=2^{V_i-V_t}.\n"
            "\\end{equation}\n",
            "with the formula\n\\begin{equation}\n\\sum_b 2^{|F_b|}=2^{V_i},\\quad "
            "B_{distinct}\\le 2^{V_i-V_t},\n\\end{equation}\nwhere $b$ are the distinct branches "
            "and $F_b$ the vertices that are flat on $b$; equality holds if and only if these are "
            "those in triangulated triangles on every branch.\n",
        ),
    ),
    "IIIA.16": (
        (
            "Accurate solutions seem to require very high precision arithmetic, especially as "
            "$V_i$ becomes larger; to ensure good results we used",
            "Double precision is enough where a test in integers proves the solutions; to ensure "
            "good results we used",
        ),
    ),
    "IIIC.2": (
        (
            "and a valley bird's foot as subsets of the folds around the vertex.",
            "and a valley bird's foot as subsets of the folds around the vertex (or, if folds are "
            "collinear, a cross of four folds of that sign in place of either).",
        ),
    ),
    "IIIC.6": (
        (
            r"such that the angles between $c_1,c_2,c_3$ are between 0 and $\pi$ and",
            r"such that the three angles from $c_1$ to $c_2$, from $c_2$ to $c_3$ and from $c_3$ "
            r"to $c_1$ are between 0 and $\pi$ and",
        ),
    ),
    "IV.4": (
        (
            "there are always two distinct folded configurations of $T'$.",
            r"there are two distinct folded configurations of $T'$ near the unfolded state if the "
            r"angle of $T$ at $v_2$ is less than $\pi$, and if it is larger and $v_2$ has degree 3 "
            r"in $T$ or (to second order) $V_e=4$; if it is $\pi$ there may be only one.",
        ),
    ),
    "IV.10": (
        (
            "under our restriction of no interior degree-3 vertices, all $V_i=1,2,3$ "
            "triangulations are H1",
            "under our restrictions of no interior degree-3 vertices and no folds joining external "
            "vertices, all triangulations of a square with $V_i=1,2,3$ are H1",
        ),
    ),
    "IV.12": (
        (
            "can be decomposed into a sequence of $V_i$ butterflies",
            "can be decomposed into a sequence of $V_i+1$ butterflies, the seed included",
        ),
    ),
    "IV.16": (
        (
            "decreased roughly exponentially from 1 at",
            "decreased faster than exponentially from 1 at",
        ),
    ),
    "IV.17": (("appears to decay exponentially", "decays more slowly than exponentially"),),
    "IV.19": (
        (
            r"where the dihedral angle of the new butterfly never reaches $\pi$",
            "where the dihedral angle of the new butterfly never reaches $0$",
        ),
    ),
    "IV.20": (
        (
            "but some other simple triangulation, e.g.~a single-vertex origami",
            "but some other simple triangulation with four boundary vertices, e.g.~a single 4-fold "
            "vertex",
        ),
    ),
    "V.1": (("$D = V_e - 4 - E$", "$D = V_e - 3 - E$"),),
    "V.2": (
        (
            "When this formula becomes negative, the constraints in the system become redundant "
            "and we instead take $D=0$.",
            "Constraints can be redundant, so that $D$ can be larger, and positive even where this "
            "formula is negative.",
        ),
    ),
    "V.5": (
        (
            "we have thus shown that it is impossible to satisfy the above orthogonality "
            "constraint for even modest numbers of internal vertices!",
            "we see that it is impossible to satisfy the above orthogonality constraint wherever "
            "the $2^{V_i}-1$ undesired branches span the $(V_i+1)$-dimensional space of foldings.",
        ),
    ),
    "V.10": (
        (
            "setting the equilibrium dihedral angle of each fold to a nonzero value",
            r"setting the equilibrium folding angle of each fold, the deviation of its dihedral "
            r"angle from $\pi$, to a nonzero value",
        ),
    ),
    "B.6": (
        (
            r"$\sigma_{i,i+1}\sin\eta_{i,i+1}=-\sigma_{i-1,i}\sin\eta{i-1,i}$",
            r"$\sigma_{i,i+1}\sin\eta_{i,i+1}=\sigma_{i-1,i}\sin\eta_{i-1,i}=-1/L_i$, and point in "
            r"opposite directions,",
        ),
    ),
    "B.14": (
        (
            r"\frac{\sigma_1}{\sin\alpha_{2,3}}=&\frac{\csc\alpha_{3,1}\csc\alpha_{2,3}}{L_3}"
            r"+\frac{-\csc\alpha_{2,3}(\cot\alpha_{1,2}+\cot\alpha_{2,3})}{L_1}\\"
            "\n"
            r"&+\frac{\csc\alpha_{2,3}\csc\alpha_{1,2}}{L_2}\nonumber\\",
            r"\frac{\sigma_1}{\sin\alpha_{2,3}}=&\frac{\csc\alpha_{3,1}\csc\alpha_{2,3}}{L_3}"
            r"+\frac{-\csc\alpha_{2,3}(\cot\alpha_{1,2}+\cot\alpha_{3,1})}{L_1}\\"
            "\n"
            r"&+\frac{\csc\alpha_{2,3}\csc\alpha_{1,2}}{L_2}\nonumber\\",
        ),
    ),
    "B.20": (
        (
            r"$\sigma_i/\sin\beta_i=\Delta\sigma_{i-1}/\sin\alpha_{i,i+1}$, as the proof",
            r"$\sigma_i/\sin\beta_i=-\Delta\sigma_{i-1}/\sin\alpha_{i,i+1}"
            r"=-\Delta\sigma_{i+1}/\sin\alpha_{i-1,i}$ for the first two, as the proof",
        ),
        (r"\frac{\sigma_i}{\sin\beta_i}=&-\csc(", r"-\frac{\sigma_i}{\sin\beta_i}=&-\csc("),
    ),
    "B.22": (
        (
            "by removing (an arbitrary) spoke vertex $i$ and the edge joining it to the hub.",
            r"by removing a spoke vertex $i$ with $\alpha_{i-1,i}+\alpha_{i,i+1}<\pi$ and the edge "
            r"joining it to the hub. (There is one unless $n+1=4$ and the spokes form two straight "
            r"lines, where $\sigma_1=\sigma_3$ and $\sigma_2=\sigma_4$.)",
        ),
    ),
    "B.26": (
        (
            r"there is a closed triangle with side lengths $\Delta\sigma_{i-1}=\sigma_{i-1}-"
            r"\sigma^0_{i-1}$, $\Delta\sigma_{i+1}=\sigma_{i+1}-\sigma^0_{i+1}$, and "
            r"$\sigma_i$ and",
            r"there is a closed triangle with side lengths $|\Delta\sigma_{i-1}|$, "
            r"$|\Delta\sigma_{i+1}|$, and $|\sigma_i|$, where $\Delta\sigma_{i-1}=\sigma_{i-1}-"
            r"\sigma^0_{i-1}$ and $\Delta\sigma_{i+1}=\sigma_{i+1}-\sigma^0_{i+1}$ are negative if "
            r"$\sigma_i>0$, and positive if $\sigma_i<0$, and",
        ),
    ),
    "C.3": (
        (
            r"Let us consider the quadratic form in Eq.~(\ref{constraint}). This form has",
            r"Let us consider the quadratic form in Eq.~(\ref{constraint}). Its negative, the form "
            r"that is written next, has",
        ),
    ),
    "C.7": (
        (
            r"\chi(N+2) = f_{N+2}\chi(N+1) - g_{N+1,N+2}^2 \chi(N).",
            r"\chi(N+2) = f_{N+1}\chi(N+1) - g_{N,N+1}^2 \chi(N).",
        ),
    ),
    "C.8": (
        (
            r"\lambda_m = f + 2 |g| \cos \left( \frac{m \pi}{N-1} \right)",
            r"\lambda_m = f - 2 |g| \cos \left( \frac{m \pi}{N-1} \right)",
        ),
        ("for $m$ ranging from $1$ to $N-1$", "for $m$ ranging from $1$ to $N-2$"),
    ),
    "C.9": (
        (
            r"\lambda_m = 2 \frac{\csc \left(2 \pi/N \right)}{L^2} \left[ \cos \left( \frac{2 \pi}"
            r"{N} \right) -  \cos \left( \frac{m \pi}{N-1} \right) \right].",
            r"\lambda_m = 2 \frac{\csc \left(2 \pi/N \right)}{L^2} \left[ \cos \left( \frac{2 \pi}"
            r"{N} \right) -  \cos \left( \frac{m \pi}{N-1} \right) \right],\quad m=1,\dots,N-2.",
        ),
    ),
    "C.13": (
        (
            r"$\chi(j)$ is also an expression for $\Delta_j$",
            r"$\chi(j+2)$ is also an expression for $\Delta_j$",
        ),
    ),
    "C.14": (
        (
            r"\frac{\Delta_{j+1}}{\Delta_j} = \frac{\csc \alpha_{j-1,j}}{L_j^2}\frac{ \sin \left("
            r"\sum_{n=1}^{j} \alpha_{n,n+1}\right)}{ \sin \left(\sum_{n=1}^{j-1} \alpha_{n,n+1}"
            r"\right)}.",
            r"\frac{\Delta_{j-1}}{\Delta_{j-2}} = \frac{\csc \alpha_{j,j+1}}{L_j^2}\frac{ \sin "
            r"\left(\sum_{n=1}^{j} \alpha_{n,n+1}\right)}{ \sin \left(\sum_{n=1}^{j-1} "
            r"\alpha_{n,n+1}\right)},\quad j=2,\dots,N-1.",
        ),
        (
            r"The first factor $\csc\alpha_{j-1,j}$ is negative if and only if $\alpha_{j-1,j}<0$",
            r"The first factor $\csc\alpha_{j,j+1}$ is negative if and only if $\alpha_{j,j+1}<0$",
        ),
    ),
    "C.15": (
        (
            "this occurs $b-C_b$ times.",
            r"this occurs $b-[\alpha_{1,2}<0]-[\alpha_{N,1}<0]-C_b$ times, as $\alpha_{1,2}$ and "
            r"$\alpha_{N,1}$ are not among these angles (a bracket is $1$ if it holds, else $0$).",
        ),
        (
            r"$2w-1$ is the {\em net} number of times $C_f-C_b$",
            r"$2w-1+[\alpha_{1,2}<0]+[\alpha_{N,1}<0]$ is the {\em net} number of times $C_f-C_b$",
        ),
        ("we have $b-C_b+C_f=b+2w-1$ sign changes", "we have $b+2w-1$ sign changes"),
    ),
    "C.16": ((r"is equal to $2\pi-\alpha_{N,1}$", r"is equal to $2\pi w-\alpha_{N,1}$"),),
    "C.19": (
        (
            "the signature changes when any of $f,b,w$ change",
            r"the signature changes each time one angle passes a multiple of $\pi$, by $(-1,1)$ or "
            r"$(1,-1)$",
        ),
    ),
    "C.23": (
        (
            "places the spokes under compression and the outer edges under tension.",
            "places the outer edges under tension, and spoke $n$ under compression where the link "
            "polygon is strictly convex at $n$ (it is unstressed where the polygon is straight "
            "there, and under tension where it is reflex there).",
        ),
    ),
    "C.24": (
        (
            r"the defining symmetric matrix is $(n+1)\times(n+1)$ and $f+b=n$",
            r"the defining symmetric matrix is $(N+1)\times(N+1)$ and $f+b=N$",
        ),
    ),
    "D.5": (
        (r"using bins of size $\pi/128$ (black line)", r"using bins of size $\pi/32$ (black line)"),
        (r"results into bins of size $\pi/128$", r"results into bins of size $\pi/32$"),
    ),
    "D.11": (
        (
            "We do not believe that this is due to a lack of data. Even though we computed fewer "
            "configurations at $V_i=8$, each configuration has twice the number of branches and "
            "hence four times as many angle pairs, so the number of data points going into the "
            "histograms is comparable.",
            "This may be due to a lack of data: the angles of one configuration are not "
            "independent, so that the number of squares counts, $1000$, $300$ and $50$, and not "
            "that of pairs, which is comparable.",
        ),
    ),
}
