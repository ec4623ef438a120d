// The parts of gifenc that the page uses; README.md says how the bundle is made from this.
export { GIFEncoder, applyPalette, quantize } from "gifenc";
