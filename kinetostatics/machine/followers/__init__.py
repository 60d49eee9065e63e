"""Followers of a cam on the crank: roller, flat-faced and swinging, as groups of the mechanism.

A new follower on a straight guide derives from `translating.GuidedFollower` and gives `RULES`, `MOTIONS`, `forces`,
`motion`, `pitch`, `closure` and `requirement`. Any other derives from `follower.Follower` and gives `LINKS`,
`declaration`, `place`, `follow` and `resolve` besides. `machine.group` explains these, except `pitch`, which returns
the roller centre or contact with two derivatives, complex, m.

May import numbers, `machine.laws`, `machine.cams` and `machine.groups`.
"""
