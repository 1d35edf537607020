"""A design of any kind: the type of what reading returns. Loads every kind."""

from gearcam.design.cam import CamDesign
from gearcam.design.gear_pair import GearPairDesign

Design = GearPairDesign | CamDesign
