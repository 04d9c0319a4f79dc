# What the firmware prints, as the events of `host_sim run --events -`, for `host_sim scenario --supervisor`. sed -unEf events.sed
s/\x1b\[[0-9;]*m//g
s/^.* agv: [0-9]+ ms: //
T
s/^=> ([A-Z]+)$/{"event":"state","to":"\1"}/p
s/^=> ([A-Z]+): ([A-Z0-9_]+)$/{"event":"state","to":"\1","reason":"\2"}/p
s/^([A-Z0-9_]+) raised \(([a-z]+)\)$/{"event":"fault","name":"\1","class":"\2","active":true}/p
s/^([A-Z0-9_]+) ended$/{"event":"fault","name":"\1","active":false}/p
s/^safety output closed$/{"event":"safety_output","closed":true}/p
s/^safety output open$/{"event":"safety_output","closed":false}/p
s/^LED code (-?[0-9]+)$/{"event":"led","code":\1}/p
s/^reset accepted$/{"event":"reset","accepted":true,"why":[]}/p
/^(reset refused:|startup waits for) /{
s/([a-z_]) ([a-z_]+)/\1","\2/g
s/([a-z_]) ([a-z_]+)/\1","\2/g
s/^reset","refused: (.*)$/{"event":"reset","accepted":false,"why":["\1"]}/p
s/^startup","waits","for","(.*)$/{"event":"startup","missing":["\1"]}/p
}
