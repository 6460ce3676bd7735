/** What a tab of the studio keeps its program with. */

export { foreignProgram, keepProgram } from "../../../src/npchip/studio/page/shell/keep";
export { asides, followTabs, setAside } from "../../../src/npchip/studio/page/shell/own";
