// Ask Flat-Folder for the flat-folded states of a sheet, with a limit of states for each component.
//
// node flat_folder.mjs CHECKOUT SHEET.fold LIMIT
//
// CHECKOUT is a clone of github.com/origamimagiro/flat-folder. The sheet has its panels
// (faces_vertices). Prints a JSON object: "states" (a decimal text), "limited" (whether a component
// has at least LIMIT), "seconds" (processor time without loading the modules), or "error" (a name).
import fs from "fs";
import path from "path";

const [checkout, sheet, most] = process.argv.slice(2);
const load = async (name) => import(path.resolve(checkout, "src", `${name}.js`));
const { NOTE } = await load("note");
const { M } = await load("math");
const { CON } = await load("constraints");
const { IO } = await load("io");
const { X } = await load("conversion");
const { SOLVER } = await load("solver");

const states = (text) => {
    const [V, , EV, EA, EF, FV] = IO.doc_type_side_2_V_VV_EV_EA_EF_FV_FE(text, "fold", true);
    const [Vf, Ff] = X.V_FV_EV_EA_2_Vf_Ff(V, FV, EV, EA);
    const [P, SP, SE] = X.L_2_V_EV_EL(EV.map((ends) => M.expand(ends, Vf)));
    if (P.length == 0) { return { error: "no epsilon found" }; }
    const [, CP] = X.V_EV_2_VV_FV(P, SP);
    const [SC, CS] = X.EV_FV_2_EF_FE(SP, CP);
    const [CF, FC] = X.EF_FV_P_SP_SE_CP_SC_2_CF_FC(EF, FV, P, SP, SE, CP, SC);
    const BF = X.EF_SP_SE_CP_CF_2_BF(EF, SP, SE, CP, CF);
    const BI = new Map(BF.map((key, i) => [key, i]));
    const BT = X.BF_BI_EF_SE_CF_SC_2_BT(BF, BI, EF, SE, CF, SC);
    const CC = X.FC_BF_BI_BT_2_CC(FC, BF, BI, BT);
    const count = { all: 0, reduced: 0 };
    const first = SOLVER.initial_assignment(
        SOLVER.EF_EA_Ff_BF_BI_2_BA0(EF, EA, Ff, BF, BI), BF, BT, BI, FC, CF, CC, count);
    // a conflict is [type, faces, errors]; other answers are lists of numbers
    if (first.length == 3 && first[1].length != undefined) { return { states: "0" }; }
    const groups = SOLVER.get_components(BI, BF, BT, first, FC, CF, CC, count);
    const found = SOLVER.solve(BI, BF, BT, first, groups, FC, CF, CC, Number(most));
    if (found.length == undefined) { return { states: "0" }; }
    return {
        states: found.reduce((product, group) => product * BigInt(group.length), 1n).toString(),
        limited: found.some((group) => group.length >= Number(most)),
    };
};

NOTE.show = false;
CON.build();
const text = fs.readFileSync(sheet, "utf8");
const before = process.cpuUsage();
let answer;
try { answer = states(text); } catch (error) { answer = { error: error.name }; }
const { user, system } = process.cpuUsage(before);
console.log(JSON.stringify({ limited: false, ...answer, seconds: (user + system) / 1e6 }));
