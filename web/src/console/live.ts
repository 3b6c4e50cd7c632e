/** What changes too often for the store: terrain, history and pictures of the selected robot. */
import { TileMap } from "../map/tiles";
import { History } from "./history";

export const terrain = new TileMap();
export const history = new History();
