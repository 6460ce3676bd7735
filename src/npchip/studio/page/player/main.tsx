/** Starts the page of `npchip export`. */

import { render } from "preact";
import { heard } from "../say";
import { open } from "./play";
import { Player } from "./player";

const place = document.getElementById("player");
if (place) render(<Player />, place);
heard(open());
