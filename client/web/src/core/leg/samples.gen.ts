// Made by client/web/make_wire.py from the robot files; not edited by hand.

import type { SampleRobot } from "./leg";

export const SAMPLES: Readonly<Record<string, SampleRobot>> = {
  "hexapod": {
    "name": "Hexapod",
    "size_mm": [100.0, 120.0, 50.0],
    "legs": [
      {"label": "R,F", "position_mm": [50.0, 45.0, -10.0], "outward_deg": 0.0, "lengths_mm": [15.0, 70.0, 70.0], "range_deg": [-150.0, 150.0]},
      {"label": "R,C", "position_mm": [50.0, 0.0, -10.0], "outward_deg": 0.0, "lengths_mm": [15.0, 70.0, 70.0], "range_deg": [-150.0, 150.0]},
      {"label": "R,B", "position_mm": [50.0, -45.0, -10.0], "outward_deg": 0.0, "lengths_mm": [15.0, 70.0, 70.0], "range_deg": [-150.0, 150.0]},
      {"label": "L,B", "position_mm": [-50.0, -45.0, -10.0], "outward_deg": 180.0, "lengths_mm": [15.0, 70.0, 70.0], "range_deg": [-150.0, 150.0]},
      {"label": "L,C", "position_mm": [-50.0, 0.0, -10.0], "outward_deg": 180.0, "lengths_mm": [15.0, 70.0, 70.0], "range_deg": [-150.0, 150.0]},
      {"label": "L,F", "position_mm": [-50.0, 45.0, -10.0], "outward_deg": 180.0, "lengths_mm": [15.0, 70.0, 70.0], "range_deg": [-150.0, 150.0]},
    ],
    "start_deg": [45.0, 0.0, -45.0, -45.0, 0.0, 45.0, 20.0, 20.0, 20.0, 20.0, 20.0, 20.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
  },
  "long-legs": {
    "name": "Long legs",
    "size_mm": [100.0, 120.0, 50.0],
    "legs": [
      {"label": "R,F", "position_mm": [50.0, 45.0, -10.0], "outward_deg": 0.0, "lengths_mm": [15.0, 85.0, 110.0], "range_deg": [-150.0, 150.0]},
      {"label": "R,C", "position_mm": [50.0, 0.0, -10.0], "outward_deg": 0.0, "lengths_mm": [15.0, 85.0, 110.0], "range_deg": [-150.0, 150.0]},
      {"label": "R,B", "position_mm": [50.0, -45.0, -10.0], "outward_deg": 0.0, "lengths_mm": [15.0, 85.0, 110.0], "range_deg": [-150.0, 150.0]},
      {"label": "L,B", "position_mm": [-50.0, -45.0, -10.0], "outward_deg": 180.0, "lengths_mm": [15.0, 85.0, 110.0], "range_deg": [-150.0, 150.0]},
      {"label": "L,C", "position_mm": [-50.0, 0.0, -10.0], "outward_deg": 180.0, "lengths_mm": [15.0, 85.0, 110.0], "range_deg": [-150.0, 150.0]},
      {"label": "L,F", "position_mm": [-50.0, 45.0, -10.0], "outward_deg": 180.0, "lengths_mm": [15.0, 85.0, 110.0], "range_deg": [-150.0, 150.0]},
    ],
    "start_deg": [35.0, 0.0, -35.0, -35.0, 0.0, 35.0, 20.0, 20.0, 20.0, 20.0, 20.0, 20.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
  },
  "quadruped": {
    "name": "Quadruped",
    "size_mm": [100.0, 100.0, 40.0],
    "legs": [
      {"label": "R,F", "position_mm": [50.0, 50.0, -10.0], "outward_deg": 45.0, "lengths_mm": [15.0, 70.0, 85.0], "range_deg": [-150.0, 150.0]},
      {"label": "R,B", "position_mm": [50.0, -50.0, -10.0], "outward_deg": -45.0, "lengths_mm": [15.0, 70.0, 85.0], "range_deg": [-150.0, 150.0]},
      {"label": "L,B", "position_mm": [-50.0, -50.0, -10.0], "outward_deg": 225.0, "lengths_mm": [15.0, 70.0, 85.0], "range_deg": [-150.0, 150.0]},
      {"label": "L,F", "position_mm": [-50.0, 50.0, -10.0], "outward_deg": 135.0, "lengths_mm": [15.0, 70.0, 85.0], "range_deg": [-150.0, 150.0]},
    ],
    "start_deg": [0.0, 0.0, 0.0, 0.0, 19.0, 19.0, 19.0, 19.0, -6.0, -6.0, -6.0, -6.0]
  },
  "octopod": {
    "name": "Octopod",
    "size_mm": [100.0, 180.0, 50.0],
    "legs": [
      {"label": "R,1", "position_mm": [50.0, 75.0, -10.0], "outward_deg": 35.0, "lengths_mm": [15.0, 70.0, 70.0], "range_deg": [-150.0, 150.0]},
      {"label": "R,2", "position_mm": [50.0, 25.0, -10.0], "outward_deg": 10.0, "lengths_mm": [15.0, 70.0, 70.0], "range_deg": [-150.0, 150.0]},
      {"label": "R,3", "position_mm": [50.0, -25.0, -10.0], "outward_deg": -10.0, "lengths_mm": [15.0, 70.0, 70.0], "range_deg": [-150.0, 150.0]},
      {"label": "R,4", "position_mm": [50.0, -75.0, -10.0], "outward_deg": -35.0, "lengths_mm": [15.0, 70.0, 70.0], "range_deg": [-150.0, 150.0]},
      {"label": "L,4", "position_mm": [-50.0, -75.0, -10.0], "outward_deg": 215.0, "lengths_mm": [15.0, 70.0, 70.0], "range_deg": [-150.0, 150.0]},
      {"label": "L,3", "position_mm": [-50.0, -25.0, -10.0], "outward_deg": 190.0, "lengths_mm": [15.0, 70.0, 70.0], "range_deg": [-150.0, 150.0]},
      {"label": "L,2", "position_mm": [-50.0, 25.0, -10.0], "outward_deg": 170.0, "lengths_mm": [15.0, 70.0, 70.0], "range_deg": [-150.0, 150.0]},
      {"label": "L,1", "position_mm": [-50.0, 75.0, -10.0], "outward_deg": 145.0, "lengths_mm": [15.0, 70.0, 70.0], "range_deg": [-150.0, 150.0]},
    ],
    "start_deg": [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 15.0, 15.0, 15.0, 15.0, 15.0, 15.0, 15.0, 15.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
  },
};
