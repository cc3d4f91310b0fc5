//! A vehicle's V2X modem: messages heard on the channel enter, `Peer*` frames on the vehicle's own bus leave.
