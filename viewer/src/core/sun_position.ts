// Where the sun stands, for diagrams: the low-precision formulas of the Astronomical Almanac, good to 0.01° from 1950 to 2050.
// Based on: J. J. Michalsky, "The Astronomical Almanac's algorithm for approximate solar position (1950–2050)", Solar Energy 40 (1988).
// Without refraction, as the bake's own directions. The light itself never comes from here: it is baked.

export interface SunPosition {
  /** Clockwise from true north, degrees 0…360. */
  azimuthDeg: number;
  /** Geometric, above the horizon, degrees. */
  elevationDeg: number;
}

export interface Site {
  latitude_deg: number;
  /** Positive to the east. */
  longitude_deg: number;
}

const degree = Math.PI / 180;
const turn = (degrees: number): number => ((degrees % 360) + 360) % 360;

/** @param utcMs milliseconds since 1970-01-01T00:00Z */
export function sunPosition(utcMs: number, site: Site): SunPosition {
  const days = utcMs / 86_400_000 - 10_957.5; // since J2000.0
  const meanLongitude = turn(280.46 + 0.9856474 * days);
  const anomaly = turn(357.528 + 0.9856003 * days) * degree;
  const longitude = (meanLongitude + 1.915 * Math.sin(anomaly) + 0.02 * Math.sin(2 * anomaly)) * degree;
  const obliquity = (23.439 - 0.0000004 * days) * degree;
  const rightAscension = Math.atan2(Math.cos(obliquity) * Math.sin(longitude), Math.cos(longitude));
  const declination = Math.asin(Math.sin(obliquity) * Math.sin(longitude));
  const hours = (((utcMs / 3_600_000) % 24) + 24) % 24;
  const siderealHours = 6.697375 + 0.0657098242 * days + hours;
  const hourAngle = (siderealHours * 15 + site.longitude_deg) * degree - rightAscension;
  const latitude = site.latitude_deg * degree;
  const elevation = Math.asin(
    Math.sin(declination) * Math.sin(latitude) + Math.cos(declination) * Math.cos(latitude) * Math.cos(hourAngle));
  const azimuth = Math.atan2(
    -Math.cos(declination) * Math.sin(hourAngle),
    Math.sin(declination) * Math.cos(latitude) - Math.cos(declination) * Math.sin(latitude) * Math.cos(hourAngle));
  return { azimuthDeg: turn(azimuth / degree), elevationDeg: elevation / degree };
}
