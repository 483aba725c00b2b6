import * as THREE from "three";
import type { Outlook } from "./named_views";

/**
 * Returns the camera at `part` of a flight, 0 to 1. It turns about the vertical axis by the shorter way and keeps its
 * distance, so that it does not fly through the patient and the horizon stays level.
 */
export function flightAt(from: Outlook, to: Outlook, part: number): Outlook {
  if (part >= 1) return { eye: to.eye.clone(), target: to.target.clone() };
  const target = from.target.clone().lerp(to.target, part);
  const [a, b] = [polar(from), polar(to)];
  const turn = Math.atan2(Math.sin(b.azimuth - a.azimuth), Math.cos(b.azimuth - a.azimuth));
  const azimuth = a.azimuth + part * turn;
  const elevation = THREE.MathUtils.lerp(a.elevation, b.elevation, part);
  // In equal ratios, as a change of distance is seen.
  const distance = a.distance * (b.distance / a.distance) ** part;
  const ring = Math.cos(elevation);
  const away = new THREE.Vector3(ring * Math.cos(azimuth), ring * Math.sin(azimuth), Math.sin(elevation));
  return { eye: target.clone().addScaledVector(away, distance), target };
}

function polar({ eye, target }: Outlook): { azimuth: number; elevation: number; distance: number } {
  const away = eye.clone().sub(target);
  const distance = Math.max(away.length(), 1e-9);
  return {
    azimuth: Math.atan2(away.y, away.x),
    elevation: Math.asin(THREE.MathUtils.clamp(away.z / distance, -1, 1)),
    distance,
  };
}
