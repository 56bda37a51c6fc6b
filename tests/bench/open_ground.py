#!/usr/bin/env python3
"""Light of a weather file on open ground, hour by hour, by nothing of the program: for annual_hours.py.

Illuminances as the file has them where its sky and sun are plain, elsewhere none: hours whose illuminances are missing, or
no light of their radiation (30 to 250 lm/W), are left out. The sun stands where the Astronomical Almanac's low precision
formulas (good to 0.01 degrees) and Bennett's refraction put it, at the middle of the hour's part in which it is up.
Source: Michalsky, "The Astronomical Almanac's algorithm for approximate solar position (1950-2050)", 1988; Bennett, "The
calculation of astronomical refraction in marine navigation", 1982.
"""
import datetime
import math


def sin_elevation(latitude, longitude, when):
    """when: UTC."""
    n = (when - datetime.datetime(2000, 1, 1, 12)).total_seconds() / 86400
    g = math.radians((357.528 + 0.9856003 * n) % 360)
    mean_longitude = (280.460 + 0.9856474 * n) % 360
    ecliptic = math.radians(mean_longitude + 1.915 * math.sin(g) + 0.020 * math.sin(2 * g))
    oblique = math.radians(23.439 - 4e-7 * n)
    ascension = math.atan2(math.cos(oblique) * math.sin(ecliptic), math.cos(ecliptic))
    declination = math.asin(math.sin(oblique) * math.sin(ecliptic))
    hours = (when.hour + when.minute / 60 + when.second / 3600 + when.microsecond / 3.6e9)
    sidereal = (6.697375 + 0.0657098242 * n + hours) * 15 + longitude
    turn, phi = math.radians(sidereal) - ascension, math.radians(latitude)
    s = math.sin(phi) * math.sin(declination) + math.cos(phi) * math.cos(declination) * math.cos(turn)
    e = math.degrees(math.asin(s))
    if e < -1:
        return s
    # True to apparent: Saemundsson's inverse of Bennett's formula, in minutes of arc.
    return math.sin(math.radians(e + 1.02 / 60 / math.tan(math.radians(e + 10.3 / (e + 5.11)))))


def light_of_weather(path):
    """Hour of the year -> illuminance of a level plane [lx]; hours with light whose illuminances can be taken."""
    light = {}
    with open(path, encoding="latin-1") as file:
        head = file.readline().split(",")
        latitude, longitude, zone = (float(x) for x in head[6:9])
        rows = [line.split(",") for line in file][7:]
    for h, row in enumerate(rows):
        year, month, day = (int(x) for x in row[:3])
        direct, diffuse, direct_lux, diffuse_lux = (float(row[k]) for k in (14, 15, 17, 18))
        if not (direct > 0 or diffuse > 0):
            continue
        pairs = ((direct, direct_lux), (diffuse, diffuse_lux))
        if any(E > 0 and not 30 * (E - 1) - 100 <= lux <= 250 * (E + 1) + 100 or (E > 0) != (lux > 0) for E, lux in pairs):
            continue
        start = datetime.datetime(year, month, day) + datetime.timedelta(hours=int(row[3]) - 1 - zone)
        steps = [start + datetime.timedelta(minutes=k + 0.5) for k in range(60)]
        up = [t for t in steps if sin_elevation(latitude, longitude, t) > 0]
        if not up:
            continue
        middle = up[0] + (up[-1] - up[0]) / 2
        light[h] = diffuse_lux + direct_lux * max(0, sin_elevation(latitude, longitude, middle))
    return light
